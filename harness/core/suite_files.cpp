#include "harness/core/suite_files.hpp"

#include <algorithm>
#include <system_error>

#include "harness/core/file.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

// Comparing the parts of paths takes longer than reading a folder.
void sort_by_bytes(std::vector<fs::path>& paths) {
  std::ranges::sort(
      paths, {}, [](const fs::path& path) -> const auto& { return path.native(); });
}

tl::unexpected<Error> unreadable(const fs::path& folder, const std::error_code& why) {
  return fail_at(folder.string(), "cannot be read: " + why.message());
}

}  // namespace

Result<std::string> read_suite_file(const fs::path& file) { return read_file(file); }

Result<std::vector<fs::path>> suite_files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failed, ignored;
  for (fs::recursive_directory_iterator it(folder, failed), end; !failed && it != end;
       it.increment(failed)) {
    if (it->is_regular_file(ignored)) files.push_back(it->path());
  }
  if (failed) return unreadable(folder, failed);
  sort_by_bytes(files);
  return files;
}

Result<std::vector<fs::path>> suite_folders_in(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code failed, ignored;
  for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
    if (it->is_directory(ignored)) folders.push_back(it->path());
  }
  if (failed) return unreadable(folder, failed);
  sort_by_bytes(folders);
  return folders;
}

bool is_suite_file(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored)) && !fs::is_directory(path, ignored);
}

bool is_suite_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

Result<void> copy_suite_files(const fs::path& folder, const fs::path& to) {
  const auto files = suite_files_below(folder);
  if (!files) return tl::unexpected(files.error());
  for (const fs::path& file : *files) {
    const auto bytes = read_suite_file(file);
    if (!bytes) return tl::unexpected(bytes.error());
    const fs::path copy = to / file.lexically_relative(folder);
    std::error_code ignored;  // write_file() reports a folder that is missing
    fs::create_directories(copy.parent_path(), ignored);
    if (auto written = write_file(copy, *bytes); !written) return written;
  }
  return {};
}

}  // namespace attest
