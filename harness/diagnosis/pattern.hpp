// What the deviations have in common that no fault of the catalogue explains.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "harness/diagnosis/observation.hpp"

namespace attest {

struct Pattern {
  Stage stage = Stage::input;
  std::string axes;                 // "yaw", "roll and pitch"; empty: all, or without axes
  std::string relation;             // "are those of the step before"; may be empty
  std::string condition;            // "the tilt error exceeds 90 deg"; may be empty
  std::size_t vectors = 0;          // failing vectors
  std::vector<std::string> groups;  // of their cases
};

struct ObservedVector {
  std::string group;  // of the case
  Observation observation;
};

// Each vector counts in the first stage in which it deviates. If one condition separates the values
// that deviate in a stage from the others, the stage has one pattern; otherwise one for each group
// of cases, or for several groups with the same condition and relation. A condition needs two
// vectors. The pattern of the most vectors comes first.
std::vector<Pattern> patterns_of(const std::vector<ObservedVector>& vectors);

}  // namespace attest
