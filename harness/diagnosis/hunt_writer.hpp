// Writes random values of one topic into the ticks of a trial.
#pragma once

#include <cstddef>

#include "harness/diagnosis/hunt_generator.hpp"
#include "harness/diagnosis/hunt_values.hpp"

namespace attest {

// Ticks [begin, end) of a trial.
struct HuntWindow {
  std::size_t begin, end;
};

// Chooses the ticks at which the topic is new, and then its values.
void write_topic(const HuntTarget& target, const HuntTopic& topic, const HuntWindow& window,
                 HuntInputs& inputs, HuntRandom& random);

// Only the values.
void write_values(const HuntTarget& target, const HuntTopic& topic, const HuntWindow& window,
                  HuntInputs& inputs, HuntRandom& random);

// Only those of a field that is no component of a quaternion.
void write_field(const HuntTarget& target, const HuntTopic& topic, const Channel& field,
                 const HuntWindow& window, HuntInputs& inputs, HuntRandom& random);

}  // namespace attest
