#include "harness/cli/suite_folder.hpp"

#include <cstdlib>
#include <set>
#include <sstream>
#include <system_error>

#include <fmt/format.h>

#include "harness/casefile/select.hpp"
#include "harness/core/file.hpp"

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
  std::istringstream text(read_file(folder / "VERSION").value_or(""));
  std::string version;
  return text >> version ? version : "unversioned";
}

std::string SuiteFolder::reference() const {
  std::istringstream text(read_file(reference_file()).value_or(""));
  std::string line;
  std::getline(text, line);
  return line;
}

std::vector<std::string> SuiteFolder::groups() const {
  std::vector<std::string> names;
  for (const auto& group : cases_by_group()) names.push_back(group.first);
  return names;
}

std::map<std::string, std::map<Rate, std::size_t>> SuiteFolder::cases_by_group() const {
  std::map<std::string, std::map<Rate, std::size_t>> groups;
  const auto all = select_cases(cases(), {});
  if (!all) return {};
  for (const auto& [the_case, configurations] : *all) {
    auto& rates = groups[the_case.profile + "/" + the_case.group];
    for (const RunConfiguration& configuration : configurations) ++rates[configuration.rate];
  }
  return groups;
}

Result<std::string> SuiteFolder::sha256() const {
  std::set<std::string> paths;
  for (const fs::path& folder : {cases(), golden()}) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) continue;  // a run reports the missing folder
    for (auto at = fs::recursive_directory_iterator(folder, error);
         at != fs::recursive_directory_iterator(); at.increment(error)) {
      if (at->path() == recorded()) at.disable_recursion_pending();
      if (at->path().extension() == ".toml") paths.insert(at->path().lexically_relative(root));
    }
    if (error) return fail_at(folder.string(), error.message());
  }
  std::string lines;
  for (const std::string& path : paths) {
    auto hash = sha256_of_file(root / path);
    if (!hash) return tl::unexpected(hash.error());
    lines += fmt::format("{}  {}\n", *hash, path);
  }
  return attest::sha256(lines);
}

std::string released_suite_sha256() { return ATTEST_SUITE_SHA256; }

std::optional<fs::path> data_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = program.parent_path().parent_path() / "share" / "attest";
  if (is_suite(installed)) return installed;
  for (fs::path above = program.parent_path(); above.has_relative_path();
       above = above.parent_path()) {
    if (is_suite(above) && fs::is_directory(above / "golden", error)) return above;
  }
  return std::nullopt;
}

Result<SuiteFolder> find_suite(const std::string& given) {
  if (!given.empty()) return named(given, "--suite");
  if (const char* folder = std::getenv("ATTEST_SUITE"); folder && *folder) {
    return named(folder, "ATTEST_SUITE");
  }
  if (const auto folder = data_folder()) return SuiteFolder{*folder};
  return fail(
      "no suite found; name the folder that holds cases/ and golden/ with --suite DIR or "
      "ATTEST_SUITE");
}

}  // namespace attest::cli
