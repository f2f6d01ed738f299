// Makes the ticks of one unit from the contents of a log.
#pragma once

#include <string>

#include "harness/ulog/flight_log.hpp"

namespace attest::ulog {

// The rules for a log, by its origin: which module published a sample, and from when a unit had it.
enum class LogRules : std::uint8_t {
  attest,      // instances tell publishers apart; a unit has a sample from its timestamp on
  controller,  // PX4 of v1.5.5 and v1.3.4: the same rules as attest
  cascade      // PX4 of v1.14 to v1.18: as in flight_log.hpp
};

// A unit with LoggedUnit::ticks. `first`: the sample before the first step, with bits in `updated`
// for the assumed topics. `finds_steps`: with LoggedUnit::found_steps. Reads the file once more.
// REQUIRES: the log has steps; `log` is of this file; `finds_steps` only of a cascade. Errors: the
// file cannot be read, or has changed.
Result<LoggedUnit> unit_of_log(ModuleContents log, const Sample& first, LogRules rules,
                               bool finds_steps, const std::string& file);

}  // namespace attest::ulog
