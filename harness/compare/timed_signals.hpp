// The signals of any trace or log, each with times of its own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/core/result.hpp"

namespace attest {

// The limit of sample times. Differences of such times, and shifts by as much, fit into 64 bits.
inline constexpr std::int64_t latest_us = (std::int64_t{1} << 62) - 1;

struct TimedSignal {
  std::string name;                     // "vehicle_rates_setpoint.roll", "pose[1].x"
  std::vector<std::uint64_t> times_us;  // increasing
  std::vector<float> values;            // one for each time
};

struct TimedSignals {
  std::string source;
  std::vector<TimedSignal> all;    // by name
  std::vector<std::string> notes;  // what is damaged or left out; one line for each

  const TimedSignal* find(const std::string& name) const;
};

// Of a ULog, or of a CSV file with a column `timestamp` in us. Memory: all signals.
//
// Names: a signal of a log is a number of a topic; further instances of a topic have their number
// in brackets. Columns `in/...` and `out/...` of a trace have the name that the signal has in a log
// of attest (trace_log.hpp): without this prefix, and `vehicle_rates_setpoint[1]` for an input that
// the module also publishes.
//
// Left out, and counted in `notes`:
// - samples whose time is not later than that of the sample before, or is later than latest_us
// - samples of a topic without a timestamp
// - signals with the name of an earlier signal
//
// Errors: the file cannot be read; a cell is no number; no column `timestamp`; no signal.
Result<TimedSignals> signals_of_log(const std::filesystem::path& path);
Result<TimedSignals> signals_of_csv(const std::filesystem::path& path);

// Sorts signals by name, and leaves out empty ones and those with the name of an earlier signal.
// Errors: no signal is left.
Result<TimedSignals> in_order(TimedSignals signals);

}  // namespace attest
