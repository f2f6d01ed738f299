// The failures of a run as a code quality report of GitLab (the format of Code Climate).
#pragma once

#include <optional>
#include <string>

#include "harness/diagnosis/diagnose.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

// A JSON array with an entry for each failing case and verdict, at its first failing vector. The
// fingerprint is the hash of case and verdict, so that GitLab recognises a known failure.
std::string code_quality_report(const RunResult& run, const std::optional<Diagnosis>& diagnosis);

}  // namespace attest
