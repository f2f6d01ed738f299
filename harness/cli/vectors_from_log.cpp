#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "controller/reference/profile.hpp"
#include "harness/casefile/log_case.hpp"
#include "harness/casefile/parse.hpp"
#include "harness/cli/command.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/read_log.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/core/file.hpp"
#include "harness/core/suggestion.hpp"

namespace attest::cli {
namespace {

namespace fs = std::filesystem;

// The law of attest, or a profile that the suite in `folder` has already.
Result<void> check_profile(const std::string& profile, const fs::path& folder) {
  std::error_code ignored;
  if (reference::profile_from_name(profile) ||
      fs::is_directory(folder / "cases" / profile, ignored))
    return {};
  const auto names = reference::profile_names();
  return fail(fmt::format("--profile {}: unknown{}; it is neither of attest nor in {}", profile,
                          suggestion(profile, {names.begin(), names.end()}),
                          (folder / "cases").string()));
}

Result<std::string> profile_in(const VectorOptions& options) {
  const auto& profiles = options.select.profiles;
  if (profiles.size() > 1) return fail("--profile is given twice; a case of a log has one");
  return profiles.empty() ? std::string() : profiles.front();
}

// A folder without cases becomes a suite that has those of the released one, too.
Result<void> make_suite(const fs::path& root, const fs::path& case_folder) {
  std::error_code failed;
  const bool is_suite = fs::exists(root / "cases", failed) || fs::exists(root / base_file, failed);
  fs::create_directories(case_folder, failed);
  if (failed) return fail_at(case_folder.string(), "cannot be made: " + failed.message());
  return is_suite ? Result<void>() : write_file(root / base_file, "released\n");
}

// The file is removed if it is not a case: the log has values that no case can have.
Result<void> write_case(const fs::path& file, const LogCase& made) {
  std::error_code failed;
  if (fs::exists(fs::symlink_status(file, failed))) {
    return fail_at(file.string(),
                   "exists, and is not overwritten; name another folder, or remove it with its "
                   "golden");
  }
  if (auto written = write_file(file, made.toml); !written) return written;
  const auto parsed = parse_case(file);
  if (parsed) return {};
  fs::remove(file, failed);
  return tl::unexpected(parsed.error());
}

// Returns the case file.
Result<fs::path> write_case_of_log(const VectorOptions& options, LogCase& made) {
  const auto profile = profile_in(options);
  if (!profile) return tl::unexpected(profile.error());
  if (const auto released = data_folder()) {
    if (auto checked =
            check_output_folder((fs::path(options.folder) / "cases").string(), {*released, {}});
        !checked) {
      return tl::unexpected(checked.error());
    }
  }
  const auto log = read_log(options.from_log, options.assumed, *profile);
  if (!log) return tl::unexpected(log.error());
  const LoggedUnit& unit = log->units.front();
  if (unit.module != Module::mc_att_control) {
    return fail_at(options.from_log,
                   fmt::format("is a log of the {}; --from-log makes cases of logs of the "
                               "controller of v1.5.5 and v1.3.4",
                               info_of(unit.module).title));
  }
  const fs::path root = options.folder;
  if (auto known = check_profile(log->profile, root); !known) return tl::unexpected(known.error());
  auto of_log = case_of_log(unit.trace, log->profile,
                            {options.from_s, options.to_s.value_or(LogStretch().to_s)}, log->notes);
  if (!of_log) return tl::unexpected(of_log.error());
  made = *std::move(of_log);
  const fs::path folder = root / "cases" / log->profile / log_case_group;
  if (auto ready = make_suite(root, folder); !ready) return tl::unexpected(ready.error());
  const fs::path file = folder / (made.name + ".toml");
  if (auto written = write_case(file, made); !written) return tl::unexpected(written.error());
  print_notes(options.from_log, log->notes);
  return file;
}

}  // namespace

int vectors_from_log_command(const VectorOptions& options, const Globals& globals) {
  LogCase made;
  const auto file = write_case_of_log(options, made);
  if (!file) return report_error(file.error());
  if (globals.quiet) return exit_ok;
  fmt::print("{}: {:g} s, {} samples of control_state\n", file->string(), made.duration_s,
             made.samples);
  fmt::print(
      "its golden: attest --suite {0} bless --group {1} --yes --reason \"...\"\n"
      "a run:      attest --suite {0} run --group {1} --port PORT\n",
      options.folder, log_case_group);
  return exit_ok;
}

}  // namespace attest::cli
