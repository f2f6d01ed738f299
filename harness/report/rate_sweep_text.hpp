// The result of a rate sweep: a row per vehicle and plant.
#pragma once

#include <string>
#include <vector>

#include "harness/measure/rate_sweep.hpp"

namespace attest {

struct RateSweepRow {
  PlantConfiguration plant_configuration;
  double lowest_rate_hz = -1;            // below 0: no rate is within the bounds
  std::vector<double> largest_delay_ms;  // by rate; below 0: no delay is within the bounds
  std::string failure;                   // of the port; empty: the port did not fail
};

// `results`: of RateSweepJobs, in their order.
std::vector<RateSweepRow> rate_sweep_rows(const std::vector<RateSweepResult>& results);

std::string render_rate_sweep(const std::vector<RateSweepRow>& rows,
                              const std::vector<LoopRate>& rates);

// "vehicle,plant,rate_hz,largest_delay_ms,lowest_rate_hz", and a row for each vehicle, plant and
// rate. A cell is empty if no delay or rate is within the bounds.
std::string rate_sweep_csv(const std::vector<RateSweepRow>& rows,
                           const std::vector<LoopRate>& rates);

}  // namespace attest
