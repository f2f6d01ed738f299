// The topics that a module publishes, and the rule of attest_unit.h for them: in a step that does
// not publish a topic, its fields other than `published` keep the values last published.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "harness/trace/channels.hpp"

namespace attest {

struct OutputTopic {
  std::string_view name;  // "vehicle_rates_setpoint"
  std::size_t published;  // index into channels() of its flag
  Block block;            // its place in a Sample, with the flag
};

// In column order. Empty for a module whose outputs are new in every step.
std::span<const OutputTopic> output_topics(Module module);

// The flag of an output's topic, as an index into channels(). Empty: the topic is new in every
// step.
std::optional<std::size_t> published_flag(const Channel& output);

// Whether the topic of this output was published. REQUIRES: an output of the module of `sample`.
bool is_published(const Channel& output, const Sample& sample);

// For each topic that `now` does not publish, copies its fields other than `published` from
// `before`, the previous step.
void keep_unpublished(Module module, const Sample& before, Sample& now);

// Clears the flags `published`, as in a step that publishes nothing.
void clear_published(Module module, Sample& sample);

}  // namespace attest
