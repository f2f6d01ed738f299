// The inverse of json_report(), to merge the reports of shards, and to run failing vectors again.
//
// A report is a file that anybody can write, and no proof. Reports that contradict themselves or
// their suite are refused, because attest does not write such reports: a vector was edited.
#pragma once

#include <string>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/core/result.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

// Members of RunResult that a report does not have keep their defaults: the folder and the vectors
// of the suite, and the elapsed times. The diagnosis and the claims in the report are not read.
struct ReadReport : RunResult {
  bool conformant = false;  // as the report says
  std::string conformance;
};

// A report of `attest run --json`. Errors: the file cannot be read, or is no such report of this
// version of the format. The report contradicts itself: totals or a number of selected vectors that
// the results do not have; a vector twice, with another id, or at a rate that was not selected; a
// verdict that the rest of its result contradicts, such as a pass with deviating ticks, a reason or
// a metric out of its bounds; a number that attest does not write, such as a negative tolerance.
Result<ReadReport> read_report(const std::string& path);

// REQUIRES: `cases` are all cases of the suite with the hash RunResult::suite_sha256, and
// RunResult::suite_is_released is true only for the released one. Errors: the suite does not have a
// vector of the report; a vector is skipped as one of the exact level, but its case is compared at
// every level; the statement of conformance is not that of the results.
Result<void> check_against(const std::vector<SelectedCase>& cases, const ReadReport& report,
                           const std::string& path);

}  // namespace attest
