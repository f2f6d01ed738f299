// Lists the mistakes of a failing port: the faults of the catalogue that give its values, and what
// the deviations have in common that no fault gives.
//
// A fault explains an output of a vector if it has the port's value at every tick. Faults are
// chosen one after the other, each for the outputs that those before it leave. Then all of them act
// together: so a vector in which several act is explained, too, and a fault that does not belong to
// them is found out, because the others explain as much without it. The same is repeated with the
// faults found so far as the law, until no fault explains more.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "controller/faults/fault.hpp"
#include "harness/diagnosis/pattern.hpp"
#include "harness/diagnosis/similarity.hpp"

namespace attest {

// A fault whose outputs are the port's.
struct Suspect {
  const faults::Fault* fault = nullptr;    // of the catalogue, or port_that_calls() (c_library.hpp)
  std::size_t explained = 0, failing = 0;  // failing vectors, in whole or in part
  std::vector<const faults::Fault*> ambiguity_group;  // at most four, which explain the same
  // How many others explain the same outputs within the tolerances, but perhaps less exactly.
  std::size_t others = 0;
  std::vector<std::string> cases = {};  // the failing ones that it explains, in whole or in part
};

struct Diagnosis {
  std::size_t vectors = 0, failing = 0;
  // Failing vectors in which all suspects together do not have the port's outputs.
  std::size_t unexplained = 0;
  std::vector<std::string> unexplained_cases;  // of these vectors
  std::vector<Suspect> suspects;               // the one that explains the most first
  std::vector<Pattern> patterns;               // of the unexplained vectors
  std::vector<std::string> remarks;  // about the verdicts of the whole run, filled in by the caller
  std::optional<faults::Stage> stage;  // of the first suspect
  // The stage of the first deviation in most of the failing vectors, as reports count it
  // (stage_of()), and the number of these vectors.
  std::optional<Stage> first_stage;
  std::size_t in_first_stage = 0;
  // The failing case in which the fewest faults of the catalogue deviate, and their number. The
  // fewer mistakes a case shows, the more its failure says about the mistake. At a tie the first.
  std::string specific_case;
  std::size_t shown_by_it = 0;
  std::string why;  // its `why`, filled in by the caller of diagnose()

  bool explains_all() const { return !suspects.empty() && unexplained == 0; }
};

// A vector at the level exact: whether it deviates at the level numeric, and which functions of the
// C library give the port's outputs.
struct ExactVector {
  std::size_t ticks = 0;
  bool deviates = false;
  LibraryMatches library;
  std::optional<Stage> stage = {};  // of its first deviation
};

// What diagnose() knows about a port. The functions take indices of vectors: the first `failing` of
// them failed, the others passed.
struct Evidence {
  std::size_t failing = 0, passing = 0;
  // The similarities of the hypotheses on these vectors. Empty if they cannot be computed.
  std::function<std::vector<VectorSimilarity>(const std::vector<std::size_t>& vectors,
                                              const std::vector<Hypothesis>&)>
      compare;
  // How the port deviates from the hypothesis; may be empty.
  std::function<std::vector<ObservedVector>(const std::vector<std::size_t>& vectors,
                                            const Hypothesis&)>
      observe = {};
  std::vector<ExactVector> exact = {};  // at the level exact: of each vector
};

// Empty when no vector deviates. At the level exact: if functions of the C library explain half of
// the failing vectors, the smallest set of them is the only suspect, and no other fault is
// searched. It must explain all vectors that pass or deviate at the level numeric, so a mistake
// refutes it. Otherwise a vector fails here if it deviates at the level numeric.
std::optional<Diagnosis> diagnose(const Evidence& evidence);

}  // namespace attest
