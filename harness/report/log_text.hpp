// The agreement with a flight log for the terminal.
#pragma once

#include <string>

#include "harness/ulog/flight_log.hpp"
#include "harness/verify/evaluate_log.hpp"

namespace attest {

// Several lines, with a newline at the end: the topics, their deviations and how they are
// explained.
std::string log_text(const FlightLog& log, const LogResult& result, const LogLimits& limits);

}  // namespace attest
