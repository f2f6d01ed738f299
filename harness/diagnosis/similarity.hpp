// How alike a port and the wrong controllers of the catalogue are on one vector: what a diagnosis
// is made of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "controller/faults/fault.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// One fault beside the port.
struct Similarity {
  std::size_t matched = 0;       // ticks at which fault and port answer the same
  std::size_t intersection = 0;  // values at which both deviate from the law
  std::size_t union_size = 0;    // values at which one of them does
};

struct VectorSimilarity {
  std::size_t ticks = 0;
  bool deviates = false;                 // the port, from the law
  std::vector<Similarity> similarities;  // of each fault of the catalogue, in its order
};

// Of whichever module; zero of the others.
struct Answer {
  attest_outputs out;
  attest_mixer_outputs mixer_out;
  attest_battery_outputs battery_out;
};
using Outputs = std::vector<Answer>;  // one a tick

Outputs outputs_of(const Trace& trace);

// What the faults of the catalogue answer. Most answer alike on one vector: as the law does.
struct FaultAnswers {
  std::vector<Outputs> distinct;      // empty for faults that do not do the profile
  std::vector<std::size_t> of_fault;  // index into `distinct`, in the order of the catalogue
};

// To the inputs of `given`, each fault alone or together with `partner`.
FaultAnswers answers_of_faults(const Trace& given, const Subject& subject,
                               const faults::Fault* partner = nullptr);

// Of each of the distinct answers. Values are the same when they differ by no more than the
// tolerances, which are not widened near a tilt error of 180 deg here.
VectorSimilarity distinct_similarity(const Outputs& port, const Outputs& law,
                                     std::span<const Outputs> distinct,
                                     const Tolerances& tolerances = Tolerances());

// Of each fault, from what its answers have been found to be like.
VectorSimilarity of_each_fault(const VectorSimilarity& distinct, const FaultAnswers& faults);

VectorSimilarity similarity(const Outputs& port, const Outputs& law, const FaultAnswers& faults,
                            const Tolerances& tolerances = Tolerances());

}  // namespace attest
