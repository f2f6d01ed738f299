// The inverse of json_report(): for merging the reports of shards, and for running again what
// failed.
#pragma once

#include <string>

#include "harness/core/result.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

// A report of `attest run --json`. Members that the report does not have keep their defaults: the
// folder and the vectors of the suite, and the elapsed times. Its diagnosis and claims are left
// out, because they follow from the results. Errors: no file, no JSON, not such a report, or one of
// another version of the format; totals or a number of selected vectors that contradict the
// results.
Result<RunResult> read_report(const std::string& path);

}  // namespace attest
