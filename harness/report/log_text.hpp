// The agreement with a flight log for the terminal.
#pragma once

#include <string>

#include "harness/ulog/flight_log.hpp"
#include "harness/verify/evaluate_log.hpp"

namespace attest {

// The agreement of one unit. Several lines, with a newline at the end: the topics, and how many of
// their deviations are explained.
std::string log_text(const LoggedUnit& log, const LogResult& result, const LogLimits& limits);

// "flight.ulg"; for a unit of v1.14 to v1.16 "flight.ulg: attitude unit".
std::string title_of(const LoggedUnit& log);

}  // namespace attest
