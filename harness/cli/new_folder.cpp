#include "harness/cli/new_folder.hpp"

#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

namespace attest::cli {
namespace {

namespace fs = std::filesystem;

Result<void> check_new(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(folder, ignored))) return {};
  if (fs::is_directory(folder, ignored) && fs::is_empty(folder, ignored)) return {};
  return fail_at(folder.string(), "exists; name a new folder");
}

}  // namespace

Result<void> make_new_folder(const std::string& given,
                             const std::function<Result<void>(const fs::path&)>& fill) {
  fs::path folder = fs::path(given).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();  // "mine/"
  if (auto checked = check_new(folder); !checked) return checked;
  // Filled under another name and then renamed, so that an error leaves no incomplete folder.
  const fs::path aside = folder.string() + fmt::format(".part-{}", ::getpid());
  std::error_code ignored;
  try {
    fs::create_directories(aside);
    auto filled = fill(aside);
    if (filled) fs::rename(aside, folder);
    if (!filled) fs::remove_all(aside, ignored);
    return filled;
  } catch (const fs::filesystem_error& error) {
    fs::remove_all(aside, ignored);
    return fail_at(given, fmt::format("cannot be made: {}", error.code().message()));
  }
}

}  // namespace attest::cli
