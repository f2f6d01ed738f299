#include "harness/cli/suite_folder.hpp"

#include <cstdlib>
#include <fstream>
#include <set>
#include <system_error>

#include <fmt/format.h>

#include "harness/suite/select.hpp"

namespace attest::cli {
namespace {

namespace fs = std::filesystem;

bool is_suite(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_directory(folder / "cases", ignored);
}

Result<SuiteFolder> named(const fs::path& folder, const char* by) {
  if (is_suite(folder)) return SuiteFolder{folder};
  return fail_at(folder.string(), fmt::format("has no cases/ folder; {} names the folder that "
                                              "holds cases/ and golden/",
                                              by));
}

}  // namespace

std::string SuiteFolder::version_of(const fs::path& folder) const {
  std::ifstream file(folder / "VERSION");
  std::string version;
  return file >> version ? version : "unversioned";
}

std::vector<std::string> SuiteFolder::groups() const {
  std::set<std::string> names;
  const auto all = select_cases(cases(), {});
  if (!all) return {};
  for (const SelectedCase& one : *all)
    names.insert(one.the_case.profile + "/" + one.the_case.group);
  return {names.begin(), names.end()};
}

Result<SuiteFolder> find_suite(const std::string& given) {
  if (!given.empty()) return named(given, "--suite");
  if (const char* folder = std::getenv("ATTEST_SUITE"); folder && *folder) {
    return named(folder, "ATTEST_SUITE");
  }
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = program.parent_path().parent_path() / "share" / "attest";
  if (is_suite(installed)) return SuiteFolder{installed};
  for (fs::path above = program.parent_path(); above.has_relative_path();
       above = above.parent_path()) {
    if (is_suite(above) && fs::is_directory(above / "golden", error)) return SuiteFolder{above};
  }
  return fail(
      "no suite found; name the folder that holds cases/ and golden/ with --suite DIR or "
      "ATTEST_SUITE");
}

}  // namespace attest::cli
