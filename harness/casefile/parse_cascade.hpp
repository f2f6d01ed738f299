// Reads what only a flight of the cascade has: the delay between the units, the allocator's task,
// resets of the estimator. Also reads any periodic task.
#pragma once

#include "harness/casefile/case.hpp"
#include "harness/core/toml.hpp"

namespace attest {

// Reads rate, phase, jitter, delay and dropped ticks. `timing` has the defaults.
TaskTiming parse_timing(const TomlTable& table, TaskTiming timing);

// REQUIRES: `parsed` has an attitude_loop, and the floor and estimator of its flight are read. With
// a floor, vehicle_land_detected comes from the plant and is removed from the topics. Errors are
// recorded in the tables.
void parse_cascade_flight(const TomlTable& root, const TomlTable& flight, Case& parsed);

}  // namespace attest
