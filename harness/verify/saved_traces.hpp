// The traces of failing vectors, for `attest run --save-traces`.
#pragma once

#include <filesystem>

#include "harness/compare/tolerance.hpp"
#include "harness/core/result.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/trace/trace.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// True if there is a folder, and the result fails.
bool saves_traces(const std::filesystem::path& folder, const VectorResult& result);

// The traces of a failing vector. Both have the inputs that the port was given.
struct JudgedTraces {
  const Trace& got;  // with the port's outputs; it ends where they end
  const Trace& want;
  const Tolerances& tolerances;
};

// The files of the traces, in the folder of the case. The stem is the label of the run
// configuration. For the attitude unit of a flight, the name of this module follows.
struct TraceFiles {
  std::filesystem::path got, want;
  std::filesystem::path tolerance;  // has the allowed |got - want| in place of each output
};
TraceFiles trace_files(const std::filesystem::path& folder, const VectorResult& result,
                       Module module);

// Writes FOLDER/PROFILE/GROUP/NAME/CONFIGURATION.got.csv, .want.csv and .tolerance.csv
// (trace_files()), and the provenance.toml with which `attest replay` reads them. If `got` has no
// tick, .want.csv is the only trace. The level events has no tolerances, so no .tolerance.csv. If a
// file cannot be written, the result's reason says so. Several processes may save vectors of the
// same case at the same time. REQUIRES: saves_traces(); the folder exists.
void save_traces(const std::filesystem::path& folder, const ModuleUnderTest& subject,
                 const JudgedTraces& traces, VectorResult& result);

}  // namespace attest
