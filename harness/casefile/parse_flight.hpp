// Reads the [flight] table of a case file.
#pragma once

#include <filesystem>

#include "harness/casefile/case.hpp"
#include "harness/core/toml.hpp"

namespace attest {

// REQUIRES: `root` has a [flight]; the rates, duration and topics of `parsed` are already read.
// `models` is the folder of the vehicles. [flight.battery] removes battery_status from the topics.
void parse_flight(const TomlTable& root, const std::filesystem::path& models, Case& parsed);

}  // namespace attest
