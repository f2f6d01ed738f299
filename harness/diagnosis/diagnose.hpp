// Finds the faults of the catalogue that a port's failures resemble. Every fault was run on some
// vectors that failed, and on some that passed (diagnosis_job.hpp).
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
  std::size_t matched = 0, ticks = 0;      // it matches `matched` of all ticks of failing vectors
  std::size_t explained = 0, failing = 0;  // it matches `explained` of the failing vectors wholly
  std::vector<const faults::Fault*> ambiguity_group;  // at most four, which match equally well
  const faults::Fault* with = nullptr;  // if not null, the numbers are of both faults together
};

struct Diagnosis {
  std::size_t vectors = 0, failing = 0;
  std::size_t unexplained = 0;  // failing vectors that no suspect matches at every tick
  // At most three, the best first. Each suspect explains at least a tenth of the failing vectors
  // that the suspects before it do not explain. An exception is a pair of suspects, of which the
  // second has the first as Suspect::with: the first may explain fewer.
  std::vector<Suspect> suspects;
  // Stage of the first suspect; without a suspect, of `nearest`.
  faults::Stage stage = faults::Stage::input;
  // The fault with the largest Jaccard index.
  const faults::Fault* nearest = nullptr;
  // Of `nearest`, 0 to 1: the number of values at which both the fault and the port deviate,
  // divided by the number of values at which at least one of them does.
  double jaccard_index = 0;
};

// Runs the same vectors again, with each fault of the catalogue combined with the given fault.
using CombinedWith = std::function<std::vector<VectorSimilarity>(const faults::Fault&)>;

// Empty when no vector fails. If the suspects leave failing vectors unexplained, `combined_with` is
// called with the fault that explains the most of all failing vectors, unless it explains none. The
// best combination replaces the suspects if it explains more failing vectors than they do, and a
// tenth or more of those that this fault leaves unexplained.
std::optional<Diagnosis> diagnose(const std::vector<VectorSimilarity>& vectors,
                                  const CombinedWith& combined_with = {});

}  // namespace attest
