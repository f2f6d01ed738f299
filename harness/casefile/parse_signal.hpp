// Reads the values of a case file that vary over time. Errors are recorded in the TomlTable.
#pragma once

#include <optional>
#include <string>

#include "harness/casefile/case.hpp"
#include "harness/core/toml.hpp"

namespace attest {

// `<stem>_ticks = 20` or `<stem>_s = 0.5`.
Span parse_span(const TomlTable& table, const std::string& stem);  // required
// The present key, `<stem>_ticks` or `<stem>_s`, for messages; empty when both are absent.
std::string span_key(const TomlTable& table, const std::string& stem);
std::optional<Span> parse_optional_span(const TomlTable& table, const std::string& stem);

// `<stem>_ticks = [0, 10]` or `<stem>_s = [0.0, 0.5]`, increasing.
std::vector<Span> parse_spans(const TomlTable& table, const std::string& stem);

// `key = 1.5`, `key = true`, or `key = { signal = "sine", ... }`.
Signal parse_signal(const TomlTable& table, const std::string& key);

// The kind of angles that a table has, and their keys. Error: it has keys of both kinds.
struct AngleKeys {
  Angles by;
  std::array<const char*, 3> keys;
};
AngleKeys angle_keys(const TomlTable& table);

// `key = { tilt_deg = 30, azimuth_deg = 90, yaw_deg = 0 }` or `key = { roll_deg = 30, pitch_deg =
// 0, yaw_deg = 0 }`, each a signal.
AttitudeSignal parse_attitude(const TomlTable& table, const std::string& key);

}  // namespace attest
