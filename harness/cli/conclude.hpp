// The end of `run` and `merge`: the diagnosis, the reports, the summary and the exit code.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/cli/globals.hpp"
#include "harness/core/file.hpp"
#include "harness/host/port_process.hpp"
#include "harness/report/report.hpp"
#include "harness/verify/run_result.hpp"

namespace attest::cli {

// A report file, opened before the run so that a path that cannot be written is reported at once.
struct ReportFile {
  AtomicFile file;
  const ReportFormat& format;
};
Result<std::vector<ReportFile>> open_reports(const ReportOptions& options);

// What the diagnosis needs to run the port again on some of the vectors.
struct Examined {
  const std::vector<SelectedCase>& cases;  // those of the results
  const HostOptions& host;
  int jobs = 1;
  std::filesystem::path traces;  // as Report::traces
  // Called before the reports are written, with the case that the diagnosis names, or an empty
  // text. May be empty.
  std::function<void(const std::string& named)> save_traces = {};
  // Called if no vector was compared: "; what may have been meant". May be empty.
  std::function<std::string()> suggestion = {};
};

// `run` has all results. Prints errors on stderr, the summary on stdout, and writes the reports.
// Returns the exit code: 0 requires that at least one vector passed, because a port that supports
// no vector does not conform.
int conclude(const RunResult& run, const Examined& examined, const ReportOptions& options,
             std::vector<ReportFile> reports, std::chrono::steady_clock::time_point begin,
             const Globals& globals);

}  // namespace attest::cli
