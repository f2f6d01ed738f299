#include "harness/process/temporary_folder.hpp"

#include <cerrno>
#include <random>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace attest {
namespace {

namespace fs = std::filesystem;

// A process that is killed may still be making files in the folder.
void remove_all_of(const fs::path& folder) {
  constexpr int most = 100;
  std::error_code failed;
  for (int i = 0; i < most && fs::exists(fs::symlink_status(folder, failed)); ++i) {
    fs::remove_all(folder, failed);
  }
}

}  // namespace

Result<TemporaryFolder> TemporaryFolder::make(std::string_view purpose) {
  std::error_code failed;
  const fs::path parent = fs::temp_directory_path(failed);
  if (failed) return fail("the folder for temporary files (TMPDIR): " + failed.message());
  return make_in(parent, fmt::format("attest-{}", purpose));
}

Result<TemporaryFolder> TemporaryFolder::make_in(const fs::path& parent, std::string_view name) {
  // The guard starts before the folder exists, and may remove it, so no other folder may have this
  // name.
  std::random_device random;
  const fs::path path =
      fs::absolute(parent) / fmt::format("{}-{:08x}{:08x}", name, random(), random());
  const auto wait = [] {
    ::close_range(0, ~0u, 0);
    while (true) ::pause();
  };
  auto remover = Process::start(wait, Process::WhenStopped::stays, [&] { remove_all_of(path); });
  if (!remover) return tl::unexpected(remover.error());
  if (::mkdir(path.c_str(), S_IRWXU) == 0) return TemporaryFolder(path, *std::move(remover));
  return fail_at(parent.string(), "a temporary folder cannot be made here: " +
                                      std::generic_category().message(errno));
}

TemporaryFolder::TemporaryFolder(TemporaryFolder&& other) noexcept
    : path_(std::exchange(other.path_, {})), remover_(std::move(other.remover_)) {}

TemporaryFolder::~TemporaryFolder() {
  if (!path_.empty()) remove_all_of(path_);
}

}  // namespace attest
