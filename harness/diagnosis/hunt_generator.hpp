// Makes the inputs of a trial: from nothing, or from those of an earlier trial that reached
// something new or of a case.
#pragma once

#include <cstdint>
#include <span>

#include "harness/diagnosis/hunt_inputs.hpp"
#include "harness/host/declarations.hpp"

namespace attest {

struct HuntTarget {
  ModuleUnderTest subject;
  Level level = Level::numeric;
  std::optional<Rate> fixed_step;  // of the port
  Lacks lacks;                     // of the port
};

// Whether each trial needs a process of its own.
inline bool makes_one_instance(const HuntTarget& target) {
  return contains(target.lacks.features, Feature::instances);
}

// A function of the arguments alone. `kept`: inputs of earlier trials of this target; may be empty.
HuntInputs make_trial(const HuntTarget& target, std::uint64_t seed, std::uint64_t trial,
                      std::span<const HuntInputs> kept);

// The inputs of a case, as far as the port has what they use, and at its fixed step.
HuntInputs fit_trial(const HuntTarget& target, HuntInputs inputs);

}  // namespace attest
