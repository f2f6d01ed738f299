// The traces that a report plots. A run with thousands of failures would need gigabytes for the
// traces of all, so only those few vectors run again whose traces the report shows.
#pragma once

#include <filesystem>
#include <optional>

#include "harness/cli/command.hpp"
#include "harness/cli/run_plan.hpp"
#include "harness/core/temporary_folder.hpp"

namespace attest::cli {

// The folder from which the reports of a run read traces: that of --save-traces, or else a
// temporary one.
class PlottedTraces {
 public:
  // Errors: the temporary folder cannot be made.
  static Result<PlottedTraces> prepare(const RunOptions& options);

  // Empty if no report plots traces.
  const std::filesystem::path& folder() const { return folder_; }

  // The options with which the run is planned. The one flight of --timing saves its traces at once.
  RunOptions planned(RunOptions options) const;

  // Call it after the run `plan.run`. Unless the traces are in the folder already, runs
  // vectors_to_plot() once more and saves theirs. Errors are printed: the report then has no plot
  // of that vector.
  void save(const RunPlan& plan, const SuiteFolder& suite, const RunOptions& options) const;

 private:
  std::optional<TemporaryFolder> temporary_;
  std::filesystem::path folder_;
};

}  // namespace attest::cli
