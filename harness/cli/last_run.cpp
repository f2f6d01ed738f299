#include "harness/cli/last_run.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "harness/core/file.hpp"
#include "harness/report/report.hpp"

namespace attest::cli {
namespace {

namespace fs = std::filesystem;

// Empty: the user has no folder for the state of programs.
fs::path report_of_this_folder() {
  const char* const state = std::getenv("XDG_STATE_HOME");
  const char* const home = std::getenv("HOME");
  fs::path folder;
  if (state != nullptr && *state == '/') {
    folder = state;
  } else if (home != nullptr && *home == '/') {
    folder = fs::path(home) / ".local" / "state";
  }
  std::error_code error;
  const fs::path here = fs::current_path(error);
  if (folder.empty() || error) return {};
  return folder / "attest" / (sha256(here.string()).substr(0, 16) + ".json");
}

}  // namespace

void remember_last_run(const RunResult& run) {
  const fs::path file = report_of_this_folder();
  if (file.empty()) return;
  std::error_code ignored;
  const auto judged = [](const VectorResult& result) { return is_judged(result.verdict); };
  if (std::ranges::none_of(run.results, judged)) return;  // a wrong profile, for example
  if (!run.failed()) {
    fs::remove(file, ignored);
    return;
  }
  fs::create_directories(file.parent_path(), ignored);
  (void)write_file(file, json_report(run));
}

Result<std::string> last_failed_run() {
  const fs::path file = report_of_this_folder();
  std::error_code error;
  if (!file.empty() && fs::is_regular_file(file, error)) return file.string();
  return fail("--last-failed: no vector failed in the last `attest run` in this folder");
}

}  // namespace attest::cli
