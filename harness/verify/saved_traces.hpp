// The traces of failing vectors, for `attest run --save-traces`.
#pragma once

#include <filesystem>

#include "harness/compare/tolerance.hpp"
#include "harness/core/result.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/trace/trace.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// True if the traces of this result are to be saved: there is a folder, and the result fails.
bool saves_traces(const std::filesystem::path& folder, const CaseResult& result);

// The traces of a failing vector. Both have the inputs that the port was given.
struct JudgedTraces {
  const Trace& got;  // with the port's outputs; it ends where they end
  const Trace& want;
  const Tolerances& tolerances;
};

// Their files, in the folder of the case. The stem is the label of the run configuration; of the
// attitude unit in a flight, also its name.
struct TraceFiles {
  std::filesystem::path got, want;
  std::filesystem::path tolerance;  // allowed |got - want| in place of each output, as in want
};
TraceFiles trace_files(const std::filesystem::path& folder, const CaseResult& result,
                       Module module);

// Writes FOLDER/PROFILE/GROUP/NAME/CONFIGURATION.got.csv, .want.csv and .tolerance.csv, and the
// provenance.toml with which `attest replay` reads them. If `got` has no tick, only .want.csv is
// written. The level events has no tolerances, so no .tolerance.csv. If a file cannot be written,
// the result's reason says so. REQUIRES: saves_traces(). Threads: processes may save vectors of the
// same case at the same time.
void save_traces(const std::filesystem::path& folder, const Subject& subject,
                 const JudgedTraces& traces, CaseResult& result);

}  // namespace attest
