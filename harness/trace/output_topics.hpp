// The topics that a module publishes, and the rule of attest_unit.h for them: in a step that does
// not publish a topic, its other fields keep the values last published.
#pragma once

#include <span>
#include <string_view>

#include "harness/trace/channels.hpp"

namespace attest {

struct OutputTopic {
  std::string_view name;  // "vehicle_rates_setpoint"
  std::size_t published;  // index into channels(), of the flag
  Block block;            // the topic in a Sample
};

// In column order. Empty for a module whose outputs are new in every step.
std::span<const OutputTopic> output_topics(Module module);

bool is_published(const OutputTopic& topic, const Sample& sample);

// If `now` does not publish a topic, copies the topic from `before`, the previous step, to `now`.
void keep_unpublished(Module module, const Sample& before, Sample& now);

// Clears the flags `published`, as in a step that publishes nothing.
void clear_published(Module module, Sample& sample);

}  // namespace attest
