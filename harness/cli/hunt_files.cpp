#include "harness/cli/hunt_files.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <system_error>

#include <fmt/format.h>

#include "harness/cli/log_cases.hpp"
#include "harness/cli/own_suite.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/diagnosis/hunt_start.hpp"
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

Result<void> check_may_be_folder(const std::string& folder) {
  std::error_code failed;
  if (!fs::exists(folder, failed) || fs::is_directory(folder, failed)) return {};
  return fail_at(folder, "is not a folder; name a folder, which need not exist");
}

Result<HuntCorpus> open_corpus(const std::string& root, const HuntOptions& hunt) {
  const fs::path folder = root, cases = folder / "cases";
  std::error_code failed;
  const bool exists = fs::exists(folder, failed);
  const bool is_suite = fs::exists(cases, failed) || fs::exists(folder / base_file, failed);
  if (exists && !is_suite && !fs::is_empty(folder, failed)) {
    return fail_at(root, "has files but no cases/, so it is no corpus; name another folder");
  }
  if (auto made = make_own_suite(folder, cases); !made) return tl::unexpected(made.error());
  return HuntCorpus::open(cases, hunt.subjects, hunt.level);
}

Result<std::vector<HuntInputs>> inputs_of_logs(const HuntFiles& files, const std::string& profile,
                                               const HuntOptions& hunt,
                                               std::vector<std::string>& notes) {
  std::vector<HuntInputs> inputs;
  for (const std::string& file : files.logs) {
    auto log = read_log(file, files.assumed, profile);
    if (!log) return tl::unexpected(log.error());
    const auto windows = windows_of(*log, file, [&](const ModuleUnderTest& unit) {
      return contains(hunt.subjects, unit.profile, unit.module);
    });
    if (!windows) return tl::unexpected(windows.error());
    print_notes(file, log->notes);
    for (const LogWindow& window : *windows) {
      std::ranges::move(trials_of_case(window.the_case, window.rate), std::back_inserter(inputs));
    }
    notes.push_back(
        fmt::format("log {}: began with {} of it", file, counted(windows->size(), "part")));
  }
  return inputs;
}

Result<void> add_findings(const HuntRun& found, HuntCorpus& corpus) {
  for (const HuntFinding& finding : found.findings) {
    if (finding.needs_others) continue;
    if (auto added = corpus.add(finding.failure.profile, finding.toml); !added) return added;
  }
  return {};
}

std::string corpus_note(const std::string& root, const HuntCorpus& corpus) {
  std::string text = fmt::format("corpus {}: began with {}", root, counted(corpus.used(), "case"));
  for (const auto& [why, count] : corpus.skipped()) {
    text += fmt::format(", skipped {} ({})", count, why);
  }
  text += fmt::format("; added {}", corpus.added());
  if (corpus.left_out() > 0) {
    text += fmt::format(", left out {} (a module in a profile has at most {})", corpus.left_out(),
                        most_of_corpus);
  }
  return text;
}

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
    report.suite = out;
    if (auto done = write_new_case(file, finding.toml); !done) return done;
    if (auto done = write_csv(trace, finding.trace, all_columns(finding.trace)); !done) return done;
    written = {file.string(), trace.string(),
               replay_command(trace, finding, report, finding.mixer)};
  }
  return {};
}

}  // namespace attest::cli
