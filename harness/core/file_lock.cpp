#include "harness/core/file_lock.hpp"

#include <cerrno>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace attest {
namespace {

constexpr mode_t lock_mode = 0644;  // less the umask

// False if the previous holder of the lock removed or renamed the file between our open() and
// flock().
bool is_still_there(int descriptor, const std::filesystem::path& file) {
  struct stat opened, there;
  return ::fstat(descriptor, &opened) == 0 && ::stat(file.c_str(), &there) == 0 &&
         opened.st_dev == there.st_dev && opened.st_ino == there.st_ino;
}

}  // namespace

int open_locked(const std::filesystem::path& file) {
  while (true) {
    const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, lock_mode);
    if (descriptor < 0) return -1;
    const bool locked = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
    const int reason = errno;
    if (locked && is_still_there(descriptor, file)) return descriptor;
    ::close(descriptor);
    errno = reason;
    if (!locked) return -1;
  }
}

}  // namespace attest
