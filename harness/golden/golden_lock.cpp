#include "harness/golden/golden_lock.hpp"

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "harness/core/file_lock.hpp"
#include "harness/golden/new_goldens.hpp"

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
  if (auto finished = finish_killed_bless(golden_root); !finished) {
    return tl::unexpected(finished.error());
  }
  return taken;
}

}  // namespace attest
