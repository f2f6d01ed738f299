#include "harness/golden/golden_lock.hpp"

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "harness/core/file_lock.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

// The descriptor of the locked file.
Result<int> lock(const fs::path& file) {
  const int descriptor = open_locked(file);
  if (descriptor >= 0) return descriptor;
  if (errno == EWOULDBLOCK) {
    return fail_at(file.string(),
                   "another `attest bless` holds this lock and is writing goldens; try again when "
                   "it has ended");
  }
  return fail_at(file.string(), fmt::format("cannot lock the goldens: {}",
                                            std::generic_category().message(errno)));
}

// The folders <profile>/<group>/<name>: the goldens in place, and *.new and *.old.
Result<std::vector<fs::path>> folders_of_cases(const fs::path& golden_root) {
  constexpr int depth_of_cases = 2;
  std::error_code error;
  std::vector<fs::path> folders;
  for (fs::recursive_directory_iterator it(golden_root, error), end; it != end && !error;
       it.increment(error)) {
    if (it.depth() < depth_of_cases) continue;
    it.disable_recursion_pending();
    std::error_code gone;
    if (it->is_directory(gone)) folders.push_back(it->path());
  }
  if (!error) return folders;
  return fail_at(golden_root.string(), fmt::format("cannot be read: {}", error.message()));
}

Result<void> remove_what_is_left(const fs::path& golden_root) {
  const auto folders = folders_of_cases(golden_root);
  if (!folders) return tl::unexpected(folders.error());
  for (const fs::path& folder : *folders) {
    const bool is_new = folder.extension() == ".new", is_old = folder.extension() == ".old";
    if (!is_new && !is_old) continue;
    const fs::path place = fs::path(folder).replace_extension();
    std::error_code error;
    if (is_old && !fs::exists(place, error)) {
      fs::rename(folder, place, error);
    } else {
      fs::remove_all(folder, error);
    }
    if (error) {
      return fail_at(folder.string(),
                     fmt::format("was left by a run that was killed, and cannot be removed: {}",
                                 error.message()));
    }
    // Removes the folders of the group and the profile, too, if they are empty now; remove() keeps
    // a folder that is not empty.
    fs::remove(folder.parent_path(), error);
    fs::remove(folder.parent_path().parent_path(), error);
  }
  return {};
}

}  // namespace

GoldenLock::GoldenLock(fs::path file, int descriptor)
    : file_(std::move(file)), descriptor_(descriptor) {}

GoldenLock::GoldenLock(GoldenLock&& other) noexcept
    : file_(std::move(other.file_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

GoldenLock::~GoldenLock() {
  if (descriptor_ < 0) return;
  ::unlink(file_.c_str());  // before it is unlocked, so that no other process has locked it
  ::close(descriptor_);
}

Result<GoldenLock> GoldenLock::take(const fs::path& golden_root) {
  std::error_code error;
  fs::create_directories(golden_root, error);
  if (error) {
    return fail_at(golden_root.string(), fmt::format("cannot be made: {}", error.message()));
  }
  const fs::path file = golden_root / ".bless.lock";
  const auto descriptor = lock(file);
  if (!descriptor) return tl::unexpected(descriptor.error());
  GoldenLock taken(file, *descriptor);
  if (auto removed = remove_what_is_left(golden_root); !removed) {
    return tl::unexpected(removed.error());
  }
  return taken;
}

}  // namespace attest
