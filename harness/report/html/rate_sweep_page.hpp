// The page of `attest sweep-rate --html`.
#pragma once

#include <string>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/host/port_says.hpp"
#include "harness/measure/rate_sweep.hpp"

namespace attest {

struct RateSweepRun {
  std::string port;  // as given
  PortSays says;
  Case the_case;
  std::vector<LoopRate> rates;
  std::vector<RateSweepResult> results;  // of RateSweepJobs, in their order
};

// The page has a table of the limits, and a table of the bounds that are missed at the highest rate
// that misses any. It plots each metric with its bounds, and the largest delay, over the rate. Each
// vehicle and plant has a line.
std::string rate_sweep_page(const RateSweepRun& run);

}  // namespace attest
