// The traces of failing vectors, for `attest run --save-traces`.
#pragma once

#include <filesystem>

#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// Writes FOLDER/PROFILE/GROUP/NAME/CONFIGURATION.got.csv and .want.csv if the result fails a run.
// Both have the inputs that the port was given. `got` has the port's outputs; null: they were lost
// with its process, and only `want` is written. An empty folder: writes nothing. Errors: a file
// cannot be written.
Result<void> save_traces(const std::filesystem::path& folder, const CaseResult& result,
                         const Trace* got, const Trace& want);

}  // namespace attest
