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

// The share of the tolerances within which the port must have a fault's values, from 0.1 to 1. A
// port that has the fault, and little rounding, has them almost to the bit, so what differs by half
// a tolerance is a near miss. The rounding shows in the results that passed: at most a tenth of
// them may deviate by more than a tenth of the share. 1 at the levels exact and events.
double share_of_tolerances(const std::vector<VectorResult>& results, Level level);

// Empty if no vector failed with a deviation. REQUIRES: `cases` are those of the run.
std::optional<Diagnosis> diagnose_run(const RunResult& run, const std::vector<SelectedCase>& cases,
                                      const HostOptions& host, const DiagnosisOptions& options);

}  // namespace attest
