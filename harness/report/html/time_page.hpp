// The page of `attest time --html`.
#pragma once

#include <string>

#include "harness/report/time_text.hpp"

namespace attest {

// The distribution of the step times with the budget, the times by group and rate, and the slowest
// vectors. REQUIRES: at least one vector was timed.
std::string time_page(const TimeRun& run);

}  // namespace attest
