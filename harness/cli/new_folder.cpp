#include "harness/cli/new_folder.hpp"

#include <system_error>

#include <fmt/format.h>

#include "harness/process/temporary_folder.hpp"

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
  try {
    const fs::path parent = fs::absolute(folder).parent_path();
    fs::create_directories(parent);
    const fs::path name = folder.filename();
    const auto aside = TemporaryFolder::make_in(parent, fmt::format(".{}", name.string()));
    if (!aside) return tl::unexpected(aside.error());
    // Filled there and then renamed, so that an error leaves no incomplete folder.
    fs::create_directory(aside->path() / name);
    auto filled = fill(aside->path() / name);
    if (filled) fs::rename(aside->path() / name, folder);
    return filled;
  } catch (const fs::filesystem_error& error) {
    return fail_at(given, fmt::format("cannot be made: {}", error.code().message()));
  }
}

}  // namespace attest::cli
