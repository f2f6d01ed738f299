#include "harness/cli/hunt_files.hpp"

#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "harness/cli/own_suite.hpp"
#include "harness/report/text.hpp"
#include "harness/trace/csv.hpp"

namespace attest::cli {
namespace {

namespace fs = std::filesystem;

// A name for which `folder` has no other case: "cascade_d_reversed_2".
std::string free_name(const fs::path& folder, const HuntFinding& finding) {
  for (int number = 1;; ++number) {
    std::string name = number == 1 ? finding.name : fmt::format("{}_{}", finding.name, number);
    std::error_code failed;
    if (!fs::exists(fs::symlink_status(folder / (name + ".toml"), failed))) return name;
  }
}

std::string replay_command(const fs::path& trace, const HuntFinding& finding,
                           const HuntReport& report, const std::string& mixer) {
  std::string command =
      fmt::format("attest replay {} --port {} --profile {}", shell_word(trace.string()),
                  shell_word(report.run.port), finding.failure.profile);
  if (report.run.level == Level::exact) command += " --level exact";
  if (!mixer.empty()) command += " --mixer " + shell_word(mixer);
  return command;
}

}  // namespace

Result<void> write_findings(const std::string& out, HuntReport& report) {
  for (HuntFinding& finding : report.found.findings) {
    HuntReport::Written& written = report.written.emplace_back();
    if (out.empty() || finding.needs_others) continue;
    const fs::path root = out;
    const fs::path folder = root / "cases" / finding.failure.profile / hunt_group;
    const fs::path traces = root / "traces" / finding.failure.profile / hunt_group;
    if (auto made = make_own_suite(root, folder); !made) return made;
    std::error_code failed;
    fs::create_directories(traces, failed);
    if (failed) return fail_at(traces.string(), "cannot be made: " + failed.message());
    finding.name = free_name(folder, finding);
    const fs::path file = folder / (finding.name + ".toml"),
                   trace = traces / (finding.name + ".csv");
    if (auto done = write_new_case(file, finding.toml); !done) return done;
    if (auto done = write_csv(trace, finding.trace, all_columns(finding.trace)); !done) return done;
    written = {file.string(), trace.string(),
               replay_command(trace, finding, report, finding.mixer)};
  }
  return {};
}

}  // namespace attest::cli
