// Computes the similarity of a port and each fault of the catalogue on one vector, for a diagnosis.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "controller/faults/fault.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/diagnosis/c_library.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// One fault compared with the port.
struct Similarity {
  std::size_t matched = 0;       // ticks at which fault and port have the same outputs
  std::size_t intersection = 0;  // values at which both deviate from the law, and are the same
  std::size_t union_size = 0;    // values at which at least one deviates from the law
  bool deviates = false;         // the fault deviates from the law
};

struct VectorSimilarity {
  std::size_t ticks = 0;
  bool deviates = false;                 // the port deviates from the law
  std::vector<Similarity> similarities;  // of each fault, or of each of FaultAnswers::distinct
  StageSet stages = {};                  // of the port's first deviation (Deviation::stages)
  std::string case_id = {};
  LibraryMatches library = {};  // at the level exact
};

// The outputs of all modules in a Sample. Those of modules other than the subject's are zero.
struct Answer {
  std::array<std::byte, outputs_size> bytes;

  Sample sample() const;  // with inputs of zero
};
using Outputs = std::vector<Answer>;  // one per tick

Outputs outputs_of(const Trace& trace);

// The outputs of the faults of the catalogue. On one vector, most faults have the same outputs as
// the law, so equal outputs are stored once.
struct FaultAnswers {
  std::vector<Outputs> distinct;      // an empty element: of faults that cannot run here
  std::vector<std::size_t> of_fault;  // index into `distinct`, in the order of the catalogue
};

// The outputs of each fault for the inputs of `given`. Each fault runs together with `partner`,
// unless that is null.
FaultAnswers answers_of_faults(const Trace& given, const ModuleUnderTest& subject,
                               const faults::Fault* partner = nullptr);

// Compares the port's outputs with each of the distinct outputs, in the channels of `module`.
// Values are the same if they differ by no more than the tolerances. These are not widened near a
// half turn (AllowedDeviation).
VectorSimilarity distinct_similarity(const Outputs& port, const Outputs& law,
                                     std::span<const Outputs> distinct,
                                     Module module = Module::mc_att_control,
                                     const Tolerances& tolerances = Tolerances());

// Converts the similarities of the distinct outputs to those of each fault.
VectorSimilarity of_each_fault(const VectorSimilarity& distinct, const FaultAnswers& faults);

VectorSimilarity similarity(const Outputs& port, const Outputs& law, const FaultAnswers& faults,
                            Module module = Module::mc_att_control,
                            const Tolerances& tolerances = Tolerances());

}  // namespace attest
