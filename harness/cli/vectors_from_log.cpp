#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/cli/log_cases.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/own_suite.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/cli/vectors.hpp"
#include "harness/core/suggestion.hpp"
#include "harness/port/profiles.hpp"

namespace attest::cli {
namespace {

namespace fs = std::filesystem;

// Errors: the profile is neither one of attest nor one for which the suite in `folder` has cases.
Result<void> check_profile(const std::string& profile, const fs::path& folder) {
  std::error_code ignored;
  if (find_profile(profile) != nullptr || fs::is_directory(folder / "cases" / profile, ignored))
    return {};
  const auto names = known_profile_names();
  return fail(fmt::format("--profile {}: unknown{}; it is neither of attest nor in {}", profile,
                          suggestion(profile, {names.begin(), names.end()}),
                          (folder / "cases").string()));
}

Result<std::string> profile_in(const VectorOptions& options) {
  const auto& profiles = options.select.profiles;
  if (profiles.size() > 1) return fail("--profile is given twice; a case of a log has one");
  return profiles.empty() ? std::string() : profiles.front();
}

struct WrittenCase {
  fs::path file;
  LogCase made;
};

// A case of each unit whose inputs the log has.
Result<std::vector<LogCase>> cases_of(const VectorOptions& options, FlightLog& log) {
  std::vector<LogCase> cases;
  for (const LoggedUnit& unit : log.units) {
    const auto steps = steps_of(unit, log);
    if (!steps) return tl::unexpected(steps.error());
    if (steps->samples.size() < 2) continue;
    auto made = case_of_log(*steps, log.profile,
                            {options.from_s, options.to_s.value_or(LogPart().to_s)}, log.notes);
    if (!made) return tl::unexpected(made.error());
    cases.push_back(*std::move(made));
  }
  if (cases.empty()) return fail_at(options.from_log, log.notes.back());
  return cases;
}

// All cases are made before the first is written.
Result<std::vector<WrittenCase>> write_cases_of_log(const VectorOptions& options) {
  const auto profile = profile_in(options);
  if (!profile) return tl::unexpected(profile.error());
  if (auto checked = check_own_suite(options.folder); !checked) {
    return tl::unexpected(checked.error());
  }
  auto log = read_log(options.from_log, options.assumed, *profile);
  if (!log) return tl::unexpected(log.error());
  const fs::path root = options.folder;
  if (auto known = check_profile(log->profile, root); !known) return tl::unexpected(known.error());
  auto cases = cases_of(options, *log);
  if (!cases) return tl::unexpected(cases.error());
  const fs::path folder = root / "cases" / log->profile / log_case_group;
  if (auto ready = make_own_suite(root, folder); !ready) return tl::unexpected(ready.error());
  std::vector<WrittenCase> all;
  for (LogCase& made : *cases) {
    const fs::path file = folder / (made.name + ".toml");
    if (auto written = write_new_case(file, made.toml); !written)
      return tl::unexpected(written.error());
    all.push_back({file, std::move(made)});
  }
  print_notes(options.from_log, log->notes);
  return all;
}

}  // namespace

int vectors_from_log(const VectorOptions& options, const Globals& globals) {
  const auto written = write_cases_of_log(options);
  if (!written) return report_error(written.error());
  if (globals.quiet) return exit_ok;
  for (const auto& [file, made] : *written) {
    fmt::print("{}: {:g} s, {} samples of {}\n", file.string(), made.duration_s, made.samples,
               made.step_topic);
  }
  fmt::print(
      "its golden: attest --suite {0} bless --group {1} --yes --reason \"...\"\n"
      "a run:      attest --suite {0} run --group {1} --port PORT\n",
      options.folder, log_case_group);
  return exit_ok;
}

}  // namespace attest::cli
