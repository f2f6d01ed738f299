// Reads the topics of a case file: what is published, when, and how its fields vary.
#pragma once

#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/core/toml.hpp"

namespace attest {

// Returns every topic of a module's inputs. A topic that the file does not mention has the values
// of a vehicle that hovers level, armed (SCHEMA.md). In a flight the baseline thrust is the
// vehicle's hover thrust. Topics that the plant or the actuators compute are then left out, and so
// is the rate unit's vehicle_rates_setpoint if the file does not have it.
std::vector<TopicStimulus> parse_topics(const TomlTable& root, Module module, bool is_flight);

}  // namespace attest
