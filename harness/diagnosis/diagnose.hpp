// What mistake a port's failures look like: the catalogue run against the vectors that failed, and
// some that did not.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "controller/faults/fault.hpp"
#include "harness/diagnosis/similarity.hpp"

namespace attest {

// A fault that answers as the port does.
struct Suspect {
  const faults::Fault* fault = nullptr;
  std::size_t matched = 0, ticks = 0;      // over the vectors that fail
  std::size_t explained = 0, failing = 0;  // vectors that it matches at every tick
  std::vector<const faults::Fault*>
      ambiguity_group;                  // faults that match as well: not told apart here
  const faults::Fault* with = nullptr;  // matches together with this one
};

struct Diagnosis {
  std::size_t vectors = 0, failing = 0;
  std::size_t unexplained = 0;  // failing vectors that no suspect matches at every tick
  // Best first; the second explains what the first does not, and so on. Empty when no fault of the
  // catalogue explains a vector.
  std::vector<Suspect> suspects;
  // Of the first suspect, or else of the fault whose deviations lie where the port's do.
  faults::Stage stage = faults::Stage::input;
  const faults::Fault* nearest = nullptr;  // in where it deviates
  double jaccard_index = 0;  // of the nearest: 0 .. 1, values both deviate at of either's
};

// Empty when nothing fails.
std::optional<Diagnosis> diagnose(const std::vector<VectorSimilarity>& vectors);

// Whether a second mistake beside the first suspect is to be looked for: some failing vectors are
// left that no suspect explains.
bool wants_partner(const Diagnosis& diagnosis);

// `vectors` are the same, of faults together with the first suspect: names the second mistake when
// the two explain more than all suspects did alone.
void add_partner(const std::vector<VectorSimilarity>& vectors, Diagnosis& diagnosis);

}  // namespace attest
