// The functions of file.hpp that find, compare and resolve paths.
#include <algorithm>
#include <system_error>
#include <utility>

#include "harness/core/file.hpp"

namespace attest {

namespace fs = std::filesystem;

fs::path behind_links(fs::path path) {
  constexpr int most = 40;  // as Linux
  fs::path target = path;
  std::error_code failed;
  for (int i = 0; i < most; ++i) {
    if (!fs::is_symlink(fs::symlink_status(target, failed))) return target;
    target = target.parent_path() / fs::read_symlink(target, failed);
  }
  return path;
}

Result<std::vector<fs::path>> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failed, ignored;
  for (fs::recursive_directory_iterator it(folder, failed), end; !failed && it != end;
       it.increment(failed)) {
    if (it->is_regular_file(ignored)) files.push_back(it->path());
  }
  if (failed) return fail_at(folder.string(), "cannot be read: " + failed.message());
  // By bytes, because comparing the parts of paths takes longer than reading a folder.
  std::ranges::sort(
      files, {}, [](const fs::path& path) -> const auto& { return path.native(); });
  return files;
}

std::string path_from_here(const fs::path& path) {
  std::error_code failed;
  const fs::path absolute = fs::weakly_canonical(fs::absolute(path, failed), failed);
  if (failed) return path.string();
  const fs::path relative = absolute.lexically_relative(fs::current_path(failed));
  const bool is_below = !failed && !relative.empty() && *relative.begin() != "..";
  return is_below ? relative.string() : absolute.string();
}

// Most paths are in normal form already, and std::filesystem takes 5 us to find that out.
std::string normal_form(const fs::path& path) {
  const std::string& text = path.native();
  const bool is_normal = !text.starts_with('.') && text.find("/.") == std::string::npos &&
                         text.find("//") == std::string::npos;
  return is_normal ? text : path.lexically_normal().native();
}

void FileHashes::add(const fs::path& path, std::string sha256) {
  hashes_[normal_form(path)] = std::move(sha256);
}

bool FileHashes::has(const fs::path& path) const { return hashes_.contains(normal_form(path)); }

Result<void> FileHashes::check(const fs::path& path, const std::string& sha256) const {
  const auto known = hashes_.find(normal_form(path));
  if (known != hashes_.end() && known->second == sha256) return {};
  return fail_at(path.string(), "changed during the run; run again while no program writes to it");
}

}  // namespace attest
