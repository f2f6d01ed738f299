// The signals of any trace or log, each with times of its own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/core/result.hpp"

namespace attest {

// The latest time of a sample, so that times can be subtracted and shifted by as much in 64 bits.
inline constexpr std::int64_t latest_us = (std::int64_t{1} << 62) - 1;

struct TimedSignal {
  std::string name;                     // "vehicle_rates_setpoint.roll", "pose[1].x"
  std::vector<std::uint64_t> times_us;  // increasing
  std::vector<float> values;            // one for each time
};

struct TimedSignals {
  std::string source;
  std::vector<TimedSignal> all;    // by name
  std::vector<std::string> notes;  // what is damaged or left out: one line each

  const TimedSignal* find(const std::string& name) const;
};

// Reads a ULog if the name ends with .ulg or .ulog, else a CSV file with a column `timestamp` in
// us.
//
// A signal of a log is a number of a topic; a topic's further instances have their number in
// brackets. Columns `in/...` and `out/...` of a trace have the name that the signal has in a log of
// attest (trace_log.hpp): without this prefix, and `vehicle_rates_setpoint[1]` for an input that
// the module also publishes. Left out, counted in `notes`: a sample whose time is not after the one
// before, or after latest_us; a topic without a timestamp; of signals with the same name, all but
// the first. Memory: all signals. Errors: the file cannot be read; a cell is no number; no column
// `timestamp`; no signal.
Result<TimedSignals> read_timed_signals(const std::filesystem::path& path);

}  // namespace attest
