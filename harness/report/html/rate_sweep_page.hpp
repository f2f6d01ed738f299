// The page of `attest sweep-rate --html`.
#pragma once

#include <string>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/host/declarations.hpp"
#include "harness/measure/rate_sweep.hpp"

namespace attest {

struct RateSweepRun {
  std::string port;  // the value of --port
  Declarations says;
  Case the_case;
  std::vector<LoopRate> rates;
  std::vector<RateSweepResult> results;  // of the RateSweepJobs, in their order
};

// The page has a table of the limits. For each vehicle and plant, a second table has the highest
// rate at which a bound is missed, and the missed bounds. It plots each metric with its bounds, and
// the largest delay, over the rate. Each vehicle on each plant has a line.
std::string rate_sweep_page(const RateSweepRun& run);

}  // namespace attest
