// The findings of a hunt: each failing trial is shrunk and made a case. A case of few ticks fits
// many faults, so all failing trials of a module are diagnosed together. Those of one cause become
// one finding.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/diagnosis/diagnose.hpp"
#include "harness/diagnosis/hunt_job.hpp"

namespace attest {

// A trial in which the port failed.
struct HuntFailure {
  std::size_t index;  // of the target
  HuntTarget target;
  HuntInputs inputs;
  VectorResult result;
  std::size_t same = 0;           // later trials that failed in the same way
  std::string silent_topic = {};  // that the port never publishes, if this is the failure
};

// A mistake of the port, and a small case that shows it.
struct HuntFinding {
  std::string name;  // of its case: the fault that it resembles, or the stage and the output
  VectorResult failure;
  std::optional<Suspect> suspect = {};  // that explains it
  std::string pattern = {};   // what the failing trials have in common that no fault explains
  std::string toml;           // the case file
  std::string mixer;          // its definition; empty: another module
  Trace trace;                // its inputs, with the outputs of the reference
  Trace got = {};             // the port's answer: ShrunkCase::got, and the inputs of these ticks
  std::size_t trials = 0;     // that failed first in the same output
  bool needs_others = false;  // fails only after other trials in the same process: has no case
};

// The fault of the catalogue that the finding resembles; null if there is none, or if others fit
// all failing trials as well: one name of several would be a guess.
const faults::Fault* fault_of(const HuntFinding& finding);

// How many faults fit all failing trials of its cause.
std::size_t fitting_faults(const HuntFinding& finding);

// In the order of the failures. `passing`: of each target, trials that the port passes, to tell
// faults apart. REQUIRES: HostOptions::said. Errors: the port cannot be started, the reference
// fails, a case does not make its inputs, an interrupt.
Result<std::vector<HuntFinding>> findings_of(std::span<const HuntFailure> failures,
                                             std::span<const std::vector<HuntInputs>> passing,
                                             const HuntWorkers& workers, const HostOptions& host);

}  // namespace attest
