// Reads the topics of a case file: what is published, when, and how its fields vary.
#pragma once

#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/core/toml.hpp"

namespace attest {

// Every topic of the inputs, those the file does not mention with the values of a vehicle that
// hovers level, armed, in STABILIZED: see SCHEMA.md.
std::vector<TopicStimulus> parse_topics(const TomlTable& root);

}  // namespace attest
