// The machine-readable report. Its format is report.schema.json, next to this file; a change that
// readers can notice changes `schema`. Deterministic: the same run on the same day gives the same
// bytes. So it has a date, but no times.
#pragma once

#include <optional>
#include <string>

#include "harness/diagnosis/diagnose.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

std::string json_report(const RunResult& run, const std::optional<Diagnosis>& diagnosis = {});

}  // namespace attest
