#include "harness/cli/suite_folder.hpp"

#include <cstdlib>
#include <map>
#include <sstream>
#include <system_error>

#include <fmt/format.h>

#include "harness/casefile/select.hpp"
#include "harness/core/suite_files.hpp"

namespace attest::cli {
namespace {

namespace fs = std::filesystem;

bool has_cases(const fs::path& folder) { return is_suite_folder(folder / "cases"); }

bool names_a_base(const fs::path& folder) { return is_suite_file(folder / base_file); }

// The suite that attest comes with.
std::optional<fs::path> released_suite() {
  const auto data = data_folder();
  if (!data) return std::nullopt;
  // An older installation in the same place had its suite in folders.
  const fs::path archive = *data / packed_suite;
  return archive_of(archive).empty() ? *data : archive;
}

// Errors: `root` is an archive that cannot be read.
Result<void> check_archive(const fs::path& root) {
  if (archive_of(root).empty()) return {};
  return suite_folders_in(root).map([](const auto&) {});
}

Result<fs::path> base_of(const fs::path& folder) {
  const fs::path file = folder / base_file;
  const auto text = read_suite_file(file);
  if (!text) return tl::unexpected(text.error());
  const std::string line = text->substr(0, text->find('\n'));
  if (text->find_first_not_of("\r\n", line.size()) != std::string::npos) {
    return fail_at(file.string(), "has a second line; it names one suite, in one line", 2, 1);
  }
  const fs::path archive = archive_of(folder);
  const fs::path here = archive.empty() ? folder : archive.parent_path();
  const auto base = line == "released" ? released_suite() : suite_in(here / line);
  if (base) {
    if (auto intact = check_archive(*base); !intact) return tl::unexpected(intact.error());
  }
  if (line.empty() || !base || !has_cases(*base)) {
    return fail_at(file.string(), fmt::format("names `{}`, which has no cases/ folder; write "
                                              "`released`, or the path of a suite from here",
                                              line));
  }
  if (!names_a_base(*base)) return *base;
  return fail_at(file.string(), fmt::format("names `{}`, which has a BASE itself", line));
}

// `given`: a suite, or a folder with the archive of one.
Result<SuiteFolder> named(const fs::path& given, const char* by) {
  const fs::path folder = suite_in(given);
  if (auto intact = check_archive(folder); !intact) return tl::unexpected(intact.error());
  if (names_a_base(folder)) {
    auto base = base_of(folder);
    if (!base) return tl::unexpected(base.error());
    return SuiteFolder{folder, *std::move(base)};
  }
  if (has_cases(folder)) return SuiteFolder{folder, {}};
  return fail_at(folder.string(), fmt::format("has no cases/ folder; {} names the folder that "
                                              "holds cases/ and golden/",
                                              by));
}

// Adds the case files below `folder`, with their paths from the folder that it is in.
Result<void> add_cases(const fs::path& folder, std::map<std::string, fs::path>& files) {
  if (!is_suite_folder(folder)) return {};  // a run reports the missing folder
  const auto found = suite_files_below(folder);
  if (!found) return tl::unexpected(found.error());
  const std::size_t prefix = folder.native().size();
  for (const fs::path& file : *found) {
    const std::string& path = file.native();
    if (!path.ends_with(".toml")) continue;
    files.insert_or_assign(files.end(), "cases" + path.substr(prefix), file);
  }
  return {};
}

// Adds the origins of the goldens: the hashes in them cover the goldens.
Result<void> add_origins(const fs::path& golden, std::map<std::string, fs::path>& files) {
  if (!is_suite_folder(golden)) return {};
  const auto profiles = suite_folders_in(golden);
  if (!profiles) return tl::unexpected(profiles.error());
  for (const fs::path& profile : *profiles) {
    const fs::path file = profile / "provenance.toml";
    if (!is_suite_file(file)) continue;
    files[fmt::format("golden/{}/provenance.toml", profile.filename().string())] = file;
  }
  return {};
}

}  // namespace

CaseFolders SuiteFolder::case_folders() const {
  CaseFolders folders;
  if (base) folders.push_back(*base / "cases");
  if (!base || has_cases(root)) folders.push_back(cases());
  return folders;
}

fs::path SuiteFolder::models() const {
  const fs::path own = root / "models";
  return base && !is_suite_folder(own) ? *base / "models" : own;
}

fs::path SuiteFolder::recorded() const {
  const fs::path own = golden() / "recorded";
  return base && !is_suite_folder(own) ? *base / "golden" / "recorded" : own;
}

std::string SuiteFolder::version_of(const fs::path& folder) const {
  std::istringstream text(read_suite_file(folder / "VERSION").value_or(""));
  std::string version;
  return text >> version ? version : "unversioned";
}

std::vector<std::string> SuiteFolder::groups() const {
  std::vector<std::string> names;
  for (const auto& group : vectors_by_group()) names.push_back(group.first);
  return names;
}

VectorsByGroup SuiteFolder::vectors_by_group() const {
  VectorsByGroup groups;
  const auto all = select_cases(case_folders(), {});
  if (!all) return {};
  for (const auto& [the_case, configurations] : *all) {
    auto& rates = groups[the_case.profile + "/" + the_case.group];
    for (const RunConfiguration& configuration : configurations) ++rates[configuration.rate];
  }
  return groups;
}

Result<SuiteHash> SuiteFolder::hash() const {
  std::map<std::string, fs::path> files;
  if (base) {
    if (auto added = add_cases(*base / "cases", files); !added) {
      return tl::unexpected(added.error());
    }
  }
  if (auto added = add_cases(cases(), files); !added) return tl::unexpected(added.error());
  if (auto added = add_origins(golden(), files); !added) return tl::unexpected(added.error());
  const auto open = keep_suite_open(base ? *base : root);
  SuiteHash suite;
  std::string lines;
  for (const auto& [path, file] : files) {
    const auto bytes = read_suite_file(file);
    if (!bytes) return tl::unexpected(bytes.error());
    std::string hash = sha256(*bytes);
    lines += fmt::format("{}  {}\n", hash, path);
    suite.files.add(file, std::move(hash));
  }
  suite.sha256 = sha256(lines);
  return suite;
}

std::optional<fs::path> data_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = program.parent_path().parent_path() / "share" / "attest";
  if (suite_in(installed) != installed || has_cases(installed)) return installed;
  for (fs::path above = program.parent_path(); above.has_relative_path();
       above = above.parent_path()) {
    if (has_cases(above) && is_suite_folder(above / "golden")) return above;
  }
  return std::nullopt;
}

fs::path suite_in(const fs::path& data) {
  const fs::path archive = data / packed_suite;
  const bool is_packed = archive_of(archive) == archive && !has_cases(data) && !names_a_base(data);
  return is_packed ? archive : data;
}

Result<void> check_can_change(const fs::path& suite) {
  if (archive_of(suite).empty()) return {};
  return fail_at(suite.string(),
                 "is an archive, which attest does not change; `attest list --extract DIR` makes a "
                 "folder of a suite, for --suite DIR");
}

bool is_installation(const fs::path& data) {
  std::error_code ignored;
  return fs::is_directory(data / "starters", ignored);  // controller/starters in the source tree
}

Result<SuiteFolder> find_suite(const std::string& given) {
  if (!given.empty()) return named(given, "--suite");
  if (const char* folder = std::getenv("ATTEST_SUITE"); folder && *folder) {
    return named(folder, "ATTEST_SUITE");
  }
  if (const auto released = released_suite()) {
    if (auto intact = check_archive(*released); !intact) return tl::unexpected(intact.error());
    return SuiteFolder{*released, {}};
  }
  return fail(
      "no suite found; name the folder that holds cases/ and golden/ with --suite DIR or "
      "ATTEST_SUITE");
}

}  // namespace attest::cli
