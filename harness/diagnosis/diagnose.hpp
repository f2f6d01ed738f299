// Finds the faults of the catalogue that a port's failures resemble. Every fault was run on some
// vectors that failed, and on some that passed (diagnosis_job.hpp).
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "controller/faults/fault.hpp"
#include "harness/diagnosis/similarity.hpp"

namespace attest {

// A fault whose outputs match the port's.
struct Suspect {
  const faults::Fault* fault = nullptr;    // of the catalogue, or port_that_calls() (c_library.hpp)
  std::size_t matched = 0, ticks = 0;      // it matches `matched` of all ticks of failing vectors
  std::size_t explained = 0, failing = 0;  // it matches `explained` of the failing vectors wholly
  std::vector<const faults::Fault*> ambiguity_group;  // at most four, which match equally well
  const faults::Fault* with = nullptr;  // if not null, the numbers are of both faults together
};

struct Diagnosis {
  std::size_t vectors = 0, failing = 0;
  std::size_t unexplained = 0;  // failing vectors that no suspect matches at every tick
  // At most three, the best first; empty if together they explain less than half of the failing
  // vectors. Each suspect explains at least a tenth of the failing vectors that the suspects before
  // it do not explain. An exception is a pair of suspects, of which the
  // second has the first as Suspect::with: the first may explain fewer.
  std::vector<Suspect> suspects;
  // Stage of the first suspect; without a suspect, of `nearest`. Empty if both are missing.
  std::optional<faults::Stage> stage;
  // The fault with the largest Jaccard index, if that is at least a half; else null. In a trial
  // with the wrong ports of tests/ports/mistakes, most names below a half were wrong.
  const faults::Fault* nearest = nullptr;
  // Of `nearest`, 0 to 1: the number of values at which the fault and the port deviate in the same
  // way, divided by the number of values at which at least one of them deviates.
  double jaccard_index = 0;
  // The stages of the first deviation in most of the failing vectors, and their number.
  StageSet first_stages;
  std::size_t in_first_stages = 0;
  // The failing case in which the fewest faults of the catalogue deviate, and their number. The
  // fewer mistakes a case shows, the more its failure says about the mistake. At a tie the first.
  std::string specific_case;
  std::size_t shown_by_it = 0;
  std::string why;  // its `why`, filled in by the caller of diagnose()
};

// Runs the same vectors again, with each fault of the catalogue combined with the given fault.
using CombinedWith = std::function<std::vector<VectorSimilarity>(const faults::Fault&)>;

// Empty when no vector fails. At the level exact: if functions of the C library explain half of the
// failing vectors, the smallest set of them is the only suspect, and no other fault is searched. It
// must explain all vectors that pass or deviate at the level numeric, so a mistake refutes it.
// Otherwise a vector fails here if it deviates at the level numeric.
//
// If the suspects leave failing vectors unexplained, `combined_with` is called with the fault that
// explains the most of all failing vectors, unless it explains none. The best combination replaces
// the suspects if it explains more failing vectors than they do, and a tenth or more of those that
// this fault leaves unexplained.
std::optional<Diagnosis> diagnose(const std::vector<VectorSimilarity>& vectors,
                                  const CombinedWith& combined_with = {});

}  // namespace attest
