// The traces that a report plots. The traces of thousands of failures would need gigabytes. So a
// run without --save-traces saves no traces, and the few vectors whose traces the report shows run
// again.
#pragma once

#include <filesystem>
#include <optional>

#include "harness/cli/globals.hpp"
#include "harness/cli/run_plan.hpp"
#include "harness/process/temporary_folder.hpp"

namespace attest::cli {

// The folder from which the reports of a run read traces: that of --save-traces, or else a
// temporary one.
class PlottedTraces {
 public:
  // Errors: the temporary folder cannot be made.
  static Result<PlottedTraces> prepare(const RunOptions& options);

  // Empty if no report plots traces.
  const std::filesystem::path& folder() const { return folder_; }

  // `options` with the change that the flight of --timing saves its traces during the run.
  RunOptions planned(RunOptions options) const;

  // Call it after the run `plan.run`. `named`: as for vectors_to_plot(). Unless the run itself
  // saved traces in the folder, runs vectors_to_plot() once more and saves their traces. The first
  // error is printed. A vector without traces has no plot in the report.
  void save(const RunPlan& plan, const SuiteFolder& suite, const RunOptions& options,
            const std::string& named) const;

 private:
  std::optional<TemporaryFolder> temporary_;
  std::filesystem::path folder_;
};

}  // namespace attest::cli
