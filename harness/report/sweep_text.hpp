// The result of a sweep: a row per vehicle and plant.
#pragma once

#include <string>
#include <vector>

#include "harness/measure/sweep.hpp"

namespace attest {

struct SweepRow {
  PlantConfiguration plant_configuration;
  double lowest_rate_hz = -1;
  std::vector<double> largest_delay_ms;  // by rate, as in sweep.hpp
  std::string failure;                   // of the port; empty if it did not fail
};

// Of the results of SweepJobs, in their order.
std::vector<SweepRow> sweep_rows(const std::vector<SweepResult>& results);

std::string render_sweep(const std::vector<SweepRow>& rows, const std::vector<LoopRate>& rates);

// "vehicle,plant,rate_hz,largest_delay_ms,lowest_rate_hz" and a row for each. A cell is
// empty if no delay or rate is within the bounds.
std::string sweep_csv(const std::vector<SweepRow>& rows, const std::vector<LoopRate>& rates);

}  // namespace attest
