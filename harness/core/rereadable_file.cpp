#include "harness/core/rereadable_file.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <string>
#include <thread>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <unistd.h>

#include "harness/core/interrupt.hpp"
#include "harness/core/suite_files.hpp"

namespace attest {
namespace {

constexpr std::size_t most_bytes = std::size_t{1} << 30;

using Clock = std::chrono::steady_clock;

// Stores the first bytes of the pipe in `begin`, if there are any. If an empty pipe has no writer,
// read() returns 0; if its writer is idle, read() fails with EAGAIN.
bool has_writer(int pipe, std::string& begin) {
  std::array<char, 4096> block;
  const ssize_t count = ::read(pipe, block.data(), block.size());
  if (count > 0) begin.assign(block.data(), static_cast<std::size_t>(count));
  return count != 0;
}

// Waits for bytes, or for an interrupt: a blocking read() would be restarted after the signal.
// Returns what read() returns; -1 after an interrupt.
ssize_t read_when_ready(int pipe, std::string& block) {
  constexpr int look_again_ms = 100;
  while (!interrupted()) {
    pollfd readable{pipe, POLLIN, 0};
    if (::poll(&readable, 1, look_again_ms) <= 0) continue;
    const ssize_t count = ::read(pipe, block.data(), block.size());
    if (count >= 0 || (errno != EINTR && errno != EAGAIN)) return count;
  }
  return -1;
}

// Returns the error; empty if all is written. `ulimit -f` can shorten the write to a file in
// memory.
std::string write_all(int copy, const std::string& bytes) {
  const ssize_t written = ::write(copy, bytes.data(), bytes.size());
  if (written < 0) return std::strerror(errno);
  const bool is_whole = static_cast<std::size_t>(written) == bytes.size();
  return is_whole ? "" : "it is larger than a file may be (`ulimit -f`)";
}

// Copies `begin`, then the rest of the pipe. Returns the error; empty if all is copied.
std::string copy_all(int pipe, int copy, std::string begin) {
  std::string block = std::move(begin);
  std::size_t copied = 0;
  while (copied <= most_bytes) {
    if (std::string wrong = write_all(copy, block); !wrong.empty()) return wrong;
    copied += block.size();
    block.resize(std::size_t{64} * 1024);
    const ssize_t count = read_when_ready(pipe, block);
    if (count == 0) return "";
    if (count < 0) return interrupted() ? "interrupted" : std::strerror(errno);
    block.resize(static_cast<std::size_t>(count));
  }
  return "it has more than 1024 MiB, the most that a trace may have there";
}

std::string copy_from(const std::filesystem::path& path, int copy,
                      std::chrono::milliseconds writer_within) {
  // Without O_NONBLOCK, open() would wait for a writer without a limit.
  const int pipe = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK);
  if (pipe < 0) return std::strerror(errno);
  const auto end = Clock::now() + writer_within;
  std::string begin;
  bool is_written = has_writer(pipe, begin);
  while (!is_written && Clock::now() < end && !interrupted()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    is_written = has_writer(pipe, begin);
  }
  const std::string wrong = is_written ? copy_all(pipe, copy, std::move(begin))
                                       : "no program writes to it, or it is empty";
  ::close(pipe);
  return wrong;
}

}  // namespace

Result<RereadableFile> RereadableFile::open(const std::filesystem::path& path,
                                            std::chrono::milliseconds writer_within) {
  std::error_code unknown;
  const bool is_packed = !archive_of(path).empty();
  if (!is_packed && !std::filesystem::is_fifo(path, unknown)) return RereadableFile(path, -1);
  const int copy = ::memfd_create("attest", MFD_CLOEXEC);
  if (copy < 0) return fail_at(path.string(), fmt::format("no memory: {}", std::strerror(errno)));
  RereadableFile file(fmt::format("/proc/self/fd/{}", copy), copy);
  if (is_packed) {
    const auto bytes = read_suite_file(path);
    if (!bytes) return tl::unexpected(bytes.error());
    const std::string wrong = write_all(copy, *bytes);
    if (!wrong.empty()) return fail_at(path.string(), "cannot be copied to memory: " + wrong);
    return file;
  }
  const std::string wrong = copy_from(path, copy, writer_within);
  if (!wrong.empty()) return fail_at(path.string(), "cannot read the pipe: " + wrong);
  return file;
}

RereadableFile::RereadableFile(RereadableFile&& other) noexcept
    : path_(std::move(other.path_)), copy_(std::exchange(other.copy_, -1)) {}

RereadableFile::~RereadableFile() {
  if (copy_ >= 0) ::close(copy_);
}

}  // namespace attest
