// The text of a golden, as CSV: the expected outputs of a case of one profile, at all its rates.
// A file has the goldens of several profiles (shared_golden.hpp).
//
//     configurations,tick,out/vehicle_rates_setpoint.roll,out/vehicle_rates_setpoint.published
//     50hz 100hz,0,0.38800925,1
//     ,1,-0.90893227,
//     250hz,0,0.4711,1
//
// A row that names configurations begins a trace, and has all cells. Configurations with equal
// outputs share a trace. In the other rows an empty cell has the value of the cell above it. A
// flight also has columns `timestamp`, `horizon_s` and `metric/<name>`.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Expected outputs of one or several configurations of a case.
struct GoldenTrace {
  std::vector<std::string> configurations;  // RunConfiguration::label()
  std::vector<std::size_t> ticks;           // of the samples, ascending
  Trace outputs;                            // without inputs; of a flight with timestamps
  // Of a flight: how long two correct controllers agree, and the metrics of the reference by name.
  std::optional<double> horizon_s = std::nullopt;
  std::map<std::string, double> metrics = {};
};

// Equal traces become one. REQUIRES: all traces have the same channels and metrics; all or none
// have a horizon.
std::string golden_text(std::vector<GoldenTrace> traces);

// `path` is for messages. Errors, each as path:line:column of `text` with what to do: a column that
// is no output of `module`, a cell that is not a value of its column, a first row without
// configurations, a configuration that has two traces, ticks that do not increase.
Result<std::vector<GoldenTrace>> parse_golden(std::string_view text,
                                              const std::filesystem::path& path, Module module);

}  // namespace attest
