#include "harness/core/suite_files.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "harness/core/archive.hpp"
#include "harness/core/file.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> unreadable(const fs::path& folder, const std::error_code& why) {
  return fail_at(folder.string(), "cannot be read: " + why.message());
}

tl::unexpected<Error> missing(const fs::path& folder) {
  return unreadable(folder, std::make_error_code(std::errc::no_such_file_or_directory));
}

Result<std::vector<fs::path>> folders_on_disk(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code failed, ignored;
  for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
    if (it->is_directory(ignored)) folders.push_back(it->path());
  }
  if (failed) return unreadable(folder, failed);
  std::ranges::sort(folders);
  return folders;
}

// ---- archives -----------------------------------------------------------------------------------

// A file or folder in an archive.
struct Place {
  std::string name;
  const Archive& archive;

  // The length of its name in the names of the files below it.
  std::size_t prefix() const { return name.empty() ? 0 : name.size() + 1; }

  // The files below it, if it is a folder.
  std::span<const std::string> names_below() const {
    const auto& all = archive.names();
    if (name.empty()) return all;
    // '0' is the byte after '/'.
    const auto begin = std::ranges::lower_bound(all, name + "/");
    return {begin, std::lower_bound(begin, all.end(), name + "0")};
  }
};

// The archives that were read, by path: their lists of files take a while to read.
using Archives = std::map<std::string, Result<Archive>>;
Archives& known_archives() {
  static Archives known;
  return known;
}

bool lies_in(const std::string& path, const std::string& folder) {
  return path.starts_with(folder) && (path.size() == folder.size() || path[folder.size()] == '/');
}

// Errors: those of Archive::open(). Empty: the path leads to no archive.
Result<std::optional<Place>> place_of(const fs::path& path) {
  Archives& known = known_archives();
  const std::string& text = path.native();
  auto found = std::ranges::find_if(
      known, [&](const auto& archive) { return lies_in(text, archive.first); });
  if (found == known.end()) {
    const fs::path root = archive_of(path);
    if (root.empty()) return std::nullopt;
    found = known.emplace(root.native(), Archive::open(root)).first;
  }
  const auto& [root, archive] = *found;
  if (!archive) return tl::unexpected(archive.error());
  std::string name = text.substr(std::min(root.size() + 1, text.size()));
  name = normal_form(name);
  if (name.ends_with('/')) name.pop_back();
  if (name == ".") name.clear();
  return Place{std::move(name), *archive};
}

}  // namespace

fs::path archive_of(const fs::path& path) {
  constexpr std::string_view ending = ".zip";
  const std::string& text = path.native();
  for (auto at = text.find(ending); at != std::string::npos; at = text.find(ending, at + 1)) {
    const std::size_t end = at + ending.size();
    if (end != text.size() && text[end] != '/') continue;
    fs::path archive(text.substr(0, end));
    std::error_code ignored;
    if (fs::is_regular_file(archive, ignored)) return archive;
  }
  return {};
}

Result<std::string> read_suite_file(const fs::path& file) {
  const auto place = place_of(file);
  if (!place) return tl::unexpected(place.error());
  return *place ? (*place)->archive.read((*place)->name, file) : read_file(file);
}

Result<std::vector<fs::path>> suite_files_below(const fs::path& folder) {
  const auto place = place_of(folder);
  if (!place) return tl::unexpected(place.error());
  if (!*place) return files_below(folder);
  std::vector<fs::path> files;
  for (const std::string& name : (*place)->names_below()) {
    files.push_back(folder / name.substr((*place)->prefix()));
  }
  if (files.empty()) return missing(folder);
  return files;
}

Result<std::vector<fs::path>> suite_folders_in(const fs::path& folder) {
  const auto place = place_of(folder);
  if (!place) return tl::unexpected(place.error());
  if (!*place) return folders_on_disk(folder);
  const auto names = (*place)->names_below();
  if (names.empty()) return missing(folder);
  std::set<std::string> found;
  for (const std::string& name : names) {
    const std::size_t begin = (*place)->prefix(), end = name.find('/', begin);
    if (end != std::string::npos) found.insert(name.substr(begin, end - begin));
  }
  std::vector<fs::path> folders;
  for (const std::string& name : found) folders.push_back(folder / name);
  return folders;
}

bool is_suite_file(const fs::path& path) {
  const auto place = place_of(path);
  if (place && *place) return std::ranges::binary_search((*place)->archive.names(), (*place)->name);
  std::error_code ignored;
  return fs::symlink_status(path, ignored).type() != fs::file_type::not_found &&
         !fs::is_directory(path, ignored);
}

bool is_suite_folder(const fs::path& path) {
  const auto place = place_of(path);
  if (place && *place) return !(*place)->names_below().empty();
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

std::shared_ptr<const void> keep_suite_open(const fs::path& suite) {
  const auto place = place_of(suite);
  return place && *place ? (*place)->archive.keep_open() : nullptr;
}

Result<void> copy_suite_files(const fs::path& folder, const fs::path& to) {
  const auto open = keep_suite_open(folder);
  const auto files = suite_files_below(folder);
  if (!files) return tl::unexpected(files.error());
  for (const fs::path& file : *files) {
    const auto bytes = read_suite_file(file);
    if (!bytes) return tl::unexpected(bytes.error());
    const fs::path copy = to / file.lexically_relative(folder);
    std::error_code ignored;  // a folder that is missing is reported below
    fs::create_directories(copy.parent_path(), ignored);
    // Not write_file(), which waits until the bytes are on the disk: seconds for a whole suite.
    std::ofstream out(copy, std::ios::binary);
    out << *bytes;
    out.close();
    if (!out) return fail_at(copy.string(), "cannot be written");
  }
  return {};
}

}  // namespace attest
