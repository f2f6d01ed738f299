// The faults of the catalogue that a port's failures resemble: the catalogue runs on the vectors
// that failed, and on some that passed.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "controller/faults/fault.hpp"
#include "harness/diagnosis/similarity.hpp"

namespace attest {

// A fault whose outputs match the port's.
struct Suspect {
  const faults::Fault* fault = nullptr;
  // Of the vectors that fail: how many of their ticks, and how many whole vectors, it matches.
  std::size_t matched = 0, ticks = 0;
  std::size_t explained = 0, failing = 0;
  std::vector<const faults::Fault*> ambiguity_group;  // faults that match equally well
  const faults::Fault* with = nullptr;                // the match is of both together
};

struct Diagnosis {
  std::size_t vectors = 0, failing = 0;
  std::size_t unexplained = 0;  // failing vectors that no suspect matches at every tick
  // Best first. Of the failing vectors that the suspects before it leave unexplained, each explains
  // at least a tenth. If the `with` of the second is the first, the two are a pair, of which the
  // first may explain less than a tenth alone.
  std::vector<Suspect> suspects;
  // Of the first suspect; without a suspect, of `nearest`.
  faults::Stage stage = faults::Stage::input;
  // The fault whose deviations overlap most with the port's (see jaccard_index).
  const faults::Fault* nearest = nullptr;
  double jaccard_index = 0;  // of the nearest, 0 .. 1: values at which both deviate / either does
};

// The same vectors, with each fault of the catalogue combined with the given fault.
using CombinedWith = std::function<std::vector<VectorSimilarity>(const faults::Fault&)>;

// Empty when no vector fails. To search for a second mistake of the port, `combined_with` is called
// with the fault that explains the most failing vectors, unless that fault explains all or none.
// The two are named if they explain more vectors together than all suspects without them do.
std::optional<Diagnosis> diagnose(const std::vector<VectorSimilarity>& vectors,
                                  const CombinedWith& combined_with = {});

}  // namespace attest
