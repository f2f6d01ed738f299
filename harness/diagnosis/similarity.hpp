// Compares a port with faults of the catalogue on one vector, value by value, for a diagnosis.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "controller/faults/fault.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/diagnosis/c_library.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Faults of the catalogue that act at the same time. Those of another law than the vector's do not
// act; without a fault, it is the law itself.
using Hypothesis = std::vector<const faults::Fault*>;

// Each fault of the catalogue, in its order, together with the faults `base`.
std::vector<Hypothesis> each_fault(const Hypothesis& base = {});

std::size_t index_in_catalogue(const faults::Fault& fault);

// A bit for each output of a module, in the order of channels().
using OutputMask = std::uint32_t;

// One hypothesis compared with the port.
struct Similarity {
  std::size_t matched = 0;  // ticks at which hypothesis and port have the same outputs
  std::size_t same = 0;     // values at which both deviate from the law, and are the same
  std::size_t other = 0;    // values at which the hypothesis deviates, and the port has another one
  OutputMask deviating = 0;  // outputs in which the hypothesis deviates from the law
  OutputMask parted = 0;     // outputs in which port and hypothesis differ at a tick
  // The distance of port and hypothesis: the sum of log2(1 + |difference| / tolerance) of all
  // values, each at most 10. So it counts how near a value is, whatever its size.
  double misfit = 0;
  std::size_t acts = never;   // the first tick at which the hypothesis deviates from the law
  std::size_t parts = never;  // the first tick at which port and hypothesis differ

  static constexpr std::size_t never = std::numeric_limits<std::size_t>::max();
};

struct VectorSimilarity {
  std::size_t ticks = 0;
  OutputMask deviating = 0;              // outputs in which the port deviates from the law
  std::vector<Similarity> similarities;  // of each hypothesis, or of each distinct one
  std::optional<Stage> stage = {};       // of the port's first deviation (stage_of())
  std::string case_id = {};
  double misfit = 0;  // of the law (Similarity::misfit)

  // The outputs in which the port deviates, and the hypothesis has the port's value at every tick.
  OutputMask explained(const Similarity& one) const { return deviating & ~one.parted; }
  // Those in which the hypothesis deviates, and the port does not.
  OutputMask contradicted(const Similarity& one) const { return one.deviating & ~deviating; }
};

// The outputs of all modules in a Sample. Those of modules other than the subject's are zero.
struct Answer {
  std::array<std::byte, outputs_size> bytes;

  Sample sample() const;  // with inputs of zero
};
using Outputs = std::vector<Answer>;  // one per tick

Outputs outputs_of(const Trace& trace);
Trace with_outputs(Trace trace, const Outputs& outputs);
// As text, for other processes.
std::string hex_of(const Outputs& outputs);
Outputs outputs_from(const std::string& hex);

// The outputs of some hypotheses. On one vector, most faults have the same outputs as the law, so
// equal outputs are stored once.
struct FaultAnswers {
  std::vector<Outputs> distinct;      // an empty element: of faults that cannot run here
  std::vector<std::size_t> of_fault;  // index into `distinct`, in the order of the hypotheses
};

// The outputs of each hypothesis for the inputs of `given`.
FaultAnswers answers_of(std::span<const Hypothesis> hypotheses, const Trace& given,
                        const ModuleUnderTest& subject);

// Compares the port's outputs with each of the distinct outputs, in the channels of `module`.
// Values are the same if they differ by no more than the tolerances. These are not widened near a
// half turn (AllowedDeviation).
VectorSimilarity distinct_similarity(const Outputs& port, const Outputs& law,
                                     std::span<const Outputs> distinct,
                                     Module module = Module::mc_att_control,
                                     const Tolerances& tolerances = Tolerances());

// Converts the similarities of the distinct outputs to those of each hypothesis.
VectorSimilarity of_each_fault(const VectorSimilarity& distinct, const FaultAnswers& faults);

VectorSimilarity similarity(const Outputs& port, const Outputs& law, const FaultAnswers& faults,
                            Module module = Module::mc_att_control,
                            const Tolerances& tolerances = Tolerances());

}  // namespace attest
