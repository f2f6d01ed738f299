// The failures of the last `run` in a folder, for `run --last-failed`.
#pragma once

#include <string>

#include "harness/core/result.hpp"
#include "harness/verify/run_result.hpp"

namespace attest::cli {

// Keeps the JSON report of a run that failed, and forgets that of the run before if this one did
// not. The report is in $XDG_STATE_HOME/attest, by default ~/.local/state/attest, one for each
// folder in which attest is started. Does nothing if the file cannot be written.
void remember_last_run(const RunResult& run);

// The file of that report. Errors: the last run in this folder did not fail.
Result<std::string> last_failed_run();

}  // namespace attest::cli
