// Reads what only a flight of the cascade has: the topic between the units, the allocator's task,
// resets of the estimator.
#pragma once

#include "harness/casefile/case.hpp"
#include "harness/core/toml.hpp"

namespace attest {

// A periodic task: rate, phase, jitter, delay, dropped ticks. `timing` has the defaults.
TaskTiming parse_timing(const TomlTable& table, TaskTiming timing);

// REQUIRES: the flight of `parsed` is read. In a flight with a floor, vehicle_land_detected comes
// from the plant and is removed from the topics. Errors are recorded in the tables.
void parse_cascade_flight(const TomlTable& root, const TomlTable& flight, Case& parsed);

}  // namespace attest
