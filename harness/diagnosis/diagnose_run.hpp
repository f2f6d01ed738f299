// Diagnoses the failures of a run: runs the port again on some vectors, and compares its outputs
// with those of faults.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/diagnosis/diagnose.hpp"
#include "harness/host/port_process.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

struct DiagnosisOptions {
  int processes = 1;
  std::function<bool()> stop = [] { return false; };  // true: the result is not needed
  std::function<void(const Error&)> on_error = [](const Error&) {};
};

// Empty if no vector failed with a deviation. REQUIRES: `cases` are those of the run.
std::optional<Diagnosis> diagnose_run(const RunResult& run, const std::vector<SelectedCase>& cases,
                                      const HostOptions& host, const DiagnosisOptions& options);

}  // namespace attest
