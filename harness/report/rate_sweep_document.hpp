// The report of `attest sweep-rate`.
#pragma once

#include <string>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/host/declarations.hpp"
#include "harness/measure/rate_sweep.hpp"
#include "harness/report/document.hpp"

namespace attest {

struct RateSweepRun {
  std::string port;  // the value of --port
  Declarations says;
  Case the_case;
  std::vector<LoopRate> rates;
  std::vector<RateSweepResult> results;  // of the RateSweepJobs, in their order
};

// It has a table of the limits. For each vehicle and plant, a second table has the highest rate at
// which a bound is missed, and the missed bounds. It plots each metric with its bounds, and the
// largest delay, over the rate. Each vehicle on each plant has a line. The verdict of its head is
// fail if the port failed.
Document rate_sweep_document(const RateSweepRun& run);

// "vehicle,plant,rate_hz,largest_delay_ms,lowest_rate_hz", and a row for each vehicle, plant and
// rate. A cell is empty if no delay or rate is within the bounds.
std::string rate_sweep_csv(const RateSweepRun& run);

}  // namespace attest
