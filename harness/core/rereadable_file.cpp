#include "harness/core/rereadable_file.hpp"

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>

namespace attest {
namespace {

constexpr int first_data_within_ms = 5000;
constexpr std::size_t most_bytes = std::size_t{1} << 30;

// Returns the error; empty: all is copied.
std::string copy_all(int from, int to) {
  pollfd data{from, POLLIN, 0};
  if (::poll(&data, 1, first_data_within_ms) == 0) return "no data within 5 s; is it written to?";
  std::array<char, std::size_t{64} * 1024> block;
  std::size_t copied = 0;
  while (copied <= most_bytes) {
    const ssize_t count = ::read(from, block.data(), block.size());
    if (count == 0) return "";
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return std::strerror(errno);
    // A file in memory takes all bytes or has none left.
    if (::write(to, block.data(), static_cast<std::size_t>(count)) != count) return "no memory";
    copied += static_cast<std::size_t>(count);
  }
  return "it has more than 1024 MiB, the most that a trace may have there";
}

// Opens without waiting for a writer, but reads with waiting.
int open_pipe(const std::filesystem::path& path) {
  const int pipe = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
  if (pipe >= 0) ::fcntl(pipe, F_SETFL, ::fcntl(pipe, F_GETFL) & ~O_NONBLOCK);
  return pipe;
}

}  // namespace

Result<RereadableFile> RereadableFile::open(const std::filesystem::path& path) {
  std::error_code unknown;
  if (!std::filesystem::is_fifo(path, unknown)) return RereadableFile(path, -1);
  const int copy = ::memfd_create("attest", MFD_CLOEXEC);
  RereadableFile file(fmt::format("/proc/self/fd/{}", copy), copy);
  const int pipe = open_pipe(path);
  const std::string wrong = copy < 0 || pipe < 0 ? std::strerror(errno) : copy_all(pipe, copy);
  if (pipe >= 0) ::close(pipe);
  if (!wrong.empty()) return fail_at(path.string(), "cannot read the pipe: " + wrong);
  return file;
}

RereadableFile::RereadableFile(RereadableFile&& other) noexcept
    : path_(std::move(other.path_)), copy_(std::exchange(other.copy_, -1)) {}

RereadableFile::~RereadableFile() {
  if (copy_ >= 0) ::close(copy_);
}

}  // namespace attest
