// Makes the trace of one unit from the contents of a log.
#pragma once

#include "harness/ulog/flight_log.hpp"

namespace attest::ulog {

// The rules of a log: whose samples it has, and from which time on a unit had an input.
enum class LogRules : std::uint8_t {
  attest,      // instances tell publishers apart; an input was there at its timestamp
  controller,  // PX4 of v1.5.5 and v1.3.4: as for attest
  cascade      // PX4 of v1.14 to v1.16: as in flight_log.hpp
};

// `first`: the sample before the first step, with `updated` set for what was assumed. REQUIRES:
// the log has steps.
LoggedUnit unit_of_log(ModuleContents& log, Sample first, LogRules rules);

}  // namespace attest::ulog
