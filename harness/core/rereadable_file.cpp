#include "harness/core/rereadable_file.hpp"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

namespace attest {
namespace {

// Errors: by errno.
bool copy_all(int from, int to) {
  std::array<char, std::size_t{64} * 1024> block;
  while (true) {
    const ssize_t count = ::read(from, block.data(), block.size());
    if (count == 0) return true;
    if (count < 0 && errno != EINTR) return false;
    for (ssize_t written = 0; written < count;) {
      const ssize_t more =
          ::write(to, block.data() + written, static_cast<std::size_t>(count - written));
      if (more < 0 && errno != EINTR) return false;
      if (more > 0) written += more;
    }
  }
}

}  // namespace

Result<RereadableFile> RereadableFile::open(const std::filesystem::path& path) {
  std::error_code unknown;
  if (!std::filesystem::is_fifo(path, unknown)) return RereadableFile(path, -1);
  const int copy = ::memfd_create("attest", MFD_CLOEXEC);
  const int pipe = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY);
  const bool is_copied = copy >= 0 && pipe >= 0 && copy_all(pipe, copy);
  const int error = errno;
  if (pipe >= 0) ::close(pipe);
  RereadableFile file(fmt::format("/proc/self/fd/{}", copy), copy);
  if (is_copied) return file;
  return fail_at(path.string(), fmt::format("cannot read the pipe: {}", std::strerror(error)));
}

RereadableFile::RereadableFile(RereadableFile&& other) noexcept
    : path_(std::move(other.path_)), copy_(std::exchange(other.copy_, -1)) {}

RereadableFile::~RereadableFile() {
  if (copy_ >= 0) ::close(copy_);
}

}  // namespace attest
