// What `attest run` will do: the selected vectors as jobs, and the context of the report.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/cli/globals.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/verify/case_job.hpp"
#include "harness/verify/expected_failures.hpp"
#include "harness/verify/run_result.hpp"

namespace attest::cli {

struct RunOptions {
  SelectionOptions select;
  HostOptions host;
  int jobs = 1;
  bool fail_fast = false;
  std::vector<std::string> parameters;  // NAME=VALUE
  std::string level = "numeric";
  ReportOptions report;
  std::string expected_failures;
  std::string timing;       // file; empty: the times of the cases
  std::string save_traces;  // folder; empty: not saved
};

// The whole run, complete and checked before the first vector runs.
struct RunPlan {
  RunResult run;
  std::optional<ExpectedFailures> expected;
  std::vector<SelectedCase> cases;
  HostOptions host;
  Jobs<VectorResult> jobs;
  std::shared_ptr<const FileHashes> suite;  // of its files, before the port was first started
};

// Asks the port for its declarations, and prints notes about the port. Errors: wrong options; the
// port cannot be opened; recorded outputs are for other inputs; a file that cannot be read.
Result<RunPlan> make_plan(const RunOptions& options, const SuiteFolder& suite);

// Whether cases without a golden are judged by the reference alone: those of a suite with a base,
// unless a port is the reference of the suite. In any other suite a missing golden is an error.
// `suite_reference`: Goldens::reference().
bool judged_by_reference(const SuiteFolder& suite, const std::string& suite_reference);

// Stores the paths of the case files and of the goldens in `run`, for its reports.
void name_files(const std::vector<SelectedCase>& cases, const Goldens& goldens,
                const SuiteFolder& suite, RunResult& run);

// Why a suite whose reference is a port has neither flights nor diagnosis.
inline constexpr const char* own_law_only =
    "flights and the diagnosis need attest's own law, and the reference of this suite is a port";

}  // namespace attest::cli
