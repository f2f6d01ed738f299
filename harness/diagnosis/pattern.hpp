// What the deviations have in common that no fault of the catalogue explains.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harness/diagnosis/observation.hpp"

namespace attest {

struct Pattern {
  Stage stage = Stage::input;
  std::string axes;                         // "yaw", "roll and pitch"; empty: all, or without axes
  std::string relation;                     // "are those of the step before"; may be empty
  std::string condition;                    // "the tilt error exceeds 90 deg"; may be empty
  ConditionKind kind = ConditionKind::law;  // of the condition
  std::size_t vectors = 0;                  // failing vectors
  std::vector<std::string> groups;          // of their cases

  // What the values do: "about yaw have the other sign, only where ...", or "deviate".
  std::string values() const;
  // Whether this has a relation, or a condition that is not of a parameter.
  bool says_more() const;
};

struct ObservedVector {
  std::string group;  // of the case
  Observation observation;
  // Of the first deviation from the expected values; empty if the vector agrees with them.
  std::optional<FirstStage> first;
};

// Each vector counts in the stage of its first deviation, as in the other reports. If one condition
// separates the values that deviate in a stage from the others, the stage has one pattern;
// otherwise one for each group of cases, or for several groups with the same condition and
// relation.
//
// A condition needs two vectors. It must hold at nearly all values that deviate, and separate them
// from the others: the more clearly, the more often its kind holds by chance. A condition of a
// parameter is named only if there is nothing else to say.
//
// Patterns with a relation, or with a condition that is not of a parameter, come before others, and
// those of more vectors before those of fewer.
std::vector<Pattern> patterns_of(const std::vector<ObservedVector>& vectors);

}  // namespace attest
