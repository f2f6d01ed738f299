// Reads the topics of a case file: what is published, when, and how its fields vary.
#pragma once

#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/core/toml.hpp"

namespace attest {

// Every topic of a module's inputs, those the file does not mention with the values of a vehicle
// that hovers level, armed, in STABILIZED: see SCHEMA.md. In a flight the thrust of the baseline is
// that of the vehicle's hover, and control_state and multirotor_motor_limits are not there: the
// plant and the mixer make them.
std::vector<TopicStimulus> parse_topics(const TomlTable& root, Module module, bool is_flight);

}  // namespace attest
