// The page of `attest sweep-rate --html`.
#pragma once

#include <string>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/host/port_says.hpp"
#include "harness/measure/sweep.hpp"

namespace attest {

struct SweepRun {
  std::string port;  // as given
  PortSays says;
  Case the_case;
  std::vector<LoopRate> rates;
  std::vector<SweepResult> results;  // of SweepJobs, in their order
};

// The limits as a table, each metric by rate with its bounds, and the largest delay by rate; a line
// for each vehicle and plant. What is missed at the highest rate that does not hold.
std::string sweep_page(const SweepRun& run);

}  // namespace attest
