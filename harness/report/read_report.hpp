// The inverse of json_report(), to merge the reports of shards, and to run failing vectors again.
#pragma once

#include <string>

#include "harness/core/result.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

// A report of `attest run --json`. Members of RunResult that the report does not have keep their
// defaults: the folder and the vectors of the suite, and the elapsed times. The diagnosis and the
// claims in the report are not read. Errors: the file cannot be read, or is no such report of this
// version of the format; totals or a number of selected vectors that contradict the results.
Result<RunResult> read_report(const std::string& path);

}  // namespace attest
