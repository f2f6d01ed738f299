// The traces of failing vectors, for `attest run --save-traces`.
#pragma once

#include <filesystem>

#include "harness/core/result.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/trace/trace.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// True if the traces of this result are to be saved: there is a folder, and the result fails.
bool saves_traces(const std::filesystem::path& folder, const CaseResult& result);

// Writes FOLDER/PROFILE/GROUP/NAME/CONFIGURATION.got.csv and .want.csv, and the provenance.toml
// with which `attest replay` reads them. Both traces have the inputs that the port was given. `got`
// has the port's outputs and ends where they end; without a tick it is not written. If a file
// cannot be written, the result's reason says so. REQUIRES: saves_traces(). Threads: processes may
// save vectors of the same case at the same time.
void save_traces(const std::filesystem::path& folder, const Subject& subject, const Trace& got,
                 const Trace& want, CaseResult& result);

}  // namespace attest
