#include "harness/process/child.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <initializer_list>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

namespace attest {
namespace {

// A port that prints at every step must not fill the machine's memory.
constexpr rlim_t max_file_bytes = std::uint64_t{max_file_mib} << 20;
constexpr rlim_t max_memory_bytes = std::uint64_t{max_memory_gib} << 30;

void write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) ::_exit(EXIT_FAILURE);  // the parent is gone
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void close_all(std::initializer_list<int> files) {
  for (const int file : files) {
    if (file >= 0) ::close(file);
  }
}

// Of what a process writes to, all that it allocates: a port that goes on allocating must not take
// the machine's memory. Sanitizers reserve terabytes.
void limit_memory() {
  if (memory_is_limited()) {
    rlimit memory{};
    ::getrlimit(RLIMIT_DATA, &memory);
    memory.rlim_cur = std::min<rlim_t>(memory.rlim_max, max_memory_bytes);
    ::setrlimit(RLIMIT_DATA, &memory);
  }
}

// What a child must have arranged, beyond what a Process has, before it runs code of others.
void isolate(int nothing, int output, int pipe) {
  rlimit files{};
  ::getrlimit(RLIMIT_FSIZE, &files);
  files.rlim_cur = std::min(files.rlim_max, max_file_bytes);
  ::setrlimit(RLIMIT_FSIZE, &files);
  ::signal(SIGXFSZ, SIG_IGN);  // writing past the limit fails, it does not kill
  ::dup2(nothing, STDIN_FILENO);
  ::close(nothing);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  // The reports and pipes that the parent has open are not the child's.
  constexpr unsigned first_other = 3;
  const auto kept = static_cast<unsigned>(pipe);
  if (kept > first_other) ::close_range(first_other, kept - 1, 0);
  ::close_range(kept + 1, ~0u, 0);
  limit_memory();
}

// Neither returns nor throws: what the parent has on its stack (files to be renamed, other
// children) is not the child's to unwind, nor are its exit handlers to run.
[[noreturn]] void work_and_end(const std::function<void(const SendLine&)>& work, int pipe) {
  // A port that forks must not have its copy of us answer too.
  const auto send = [pipe, self = ::getpid()](const std::string& line) {
    if (::getpid() != self) ::_exit(EXIT_SUCCESS);
    write_all(pipe, line + "\n");
  };
  try {
    work(send);
  } catch (const std::exception& error) {
    fmt::print(stderr, "uncaught exception: {}\n", error.what());
    std::abort();
  } catch (...) {
    std::abort();
  }
  ::_exit(EXIT_SUCCESS);
}

}  // namespace

bool memory_is_limited() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return false;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
  return false;
#else
  return true;
#endif
#else
  return true;
#endif
}

void allow_large_files() {
  rlimit files{};
  ::getrlimit(RLIMIT_FSIZE, &files);
  files.rlim_cur = files.rlim_max;
  ::setrlimit(RLIMIT_FSIZE, &files);
}

Result<Child> Child::spawn(const std::function<void(const SendLine&)>& work) {
  // All of it before the fork: what cannot be opened is no fault of the work.
  std::array<int, 2> ends{-1, -1};
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int output = ::memfd_create("attest-port-output", MFD_CLOEXEC);
  if (nothing < 0 || output < 0 || ::pipe2(ends.data(), O_CLOEXEC) != 0) {
    const int reason = errno;
    close_all({nothing, output});
    return fail(fmt::format("cannot open the files of a worker: {}{}", std::strerror(reason),
                            reason == EMFILE ? " (`ulimit -n` limits how many are open)" : ""));
  }
  auto process = Process::start([&] {
    ::close(ends[0]);
    isolate(nothing, output, ends[1]);
    work_and_end(work, ends[1]);
  });
  close_all({nothing, ends[1]});
  if (process) return Child(*std::move(process), ends[0], output);
  close_all({ends[0], output});
  return tl::unexpected(process.error());
}

Child::Child(Child&& other) noexcept
    : process_(std::move(other.process_)),
      pipe_(std::exchange(other.pipe_, -1)),
      output_(std::exchange(other.output_, -1)),
      partial_(std::move(other.partial_)) {}

Child& Child::operator=(Child&& other) noexcept {
  if (this == &other) return *this;
  close_files();
  process_ = std::move(other.process_);
  pipe_ = std::exchange(other.pipe_, -1);
  output_ = std::exchange(other.output_, -1);
  partial_ = std::move(other.partial_);
  return *this;
}

Child::~Child() { close_files(); }

void Child::close_files() { close_all({pipe_, output_}); }

std::vector<std::string> Child::read_lines(bool& ended) {
  std::array<char, 65536> buffer;
  const ssize_t count = ::read(pipe_, buffer.data(), buffer.size());
  ended = count == 0 || (count < 0 && errno != EINTR);
  if (count > 0) partial_.append(buffer.data(), static_cast<std::size_t>(count));
  std::vector<std::string> lines;
  for (std::size_t end; (end = partial_.find('\n')) != std::string::npos;) {
    lines.push_back(partial_.substr(0, end));
    partial_.erase(0, end + 1);
  }
  return lines;
}

std::optional<std::string> Child::wait_for_line(double timeout_s,
                                                const std::function<bool()>& stop) {
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + std::chrono::duration<double>(timeout_s);
  pollfd readable{pipe_, POLLIN, 0};
  bool ended = false;
  constexpr double look_every_ms = 100;  // whether to stop
  while (!ended) {
    const std::chrono::duration<double, std::milli> left = deadline - Clock::now();
    if (left.count() <= 0 || stop()) break;
    const int ready =
        ::poll(&readable, 1, static_cast<int>(std::ceil(std::min(left.count(), look_every_ms))));
    if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
    if (ready < 0) break;
    const auto lines = read_lines(ended);
    if (!lines.empty()) return lines.front();
  }
  if (!ended) kill();
  return std::nullopt;
}

std::string Child::end() {
  constexpr double enough_to_end_s = 2;
  const bool was_killed = process_.was_killed();
  const Ending ending = process_.end(enough_to_end_s);
  const bool went_on = ending.was_killed && !was_killed;
  return went_on ? "closed the pipe on which it answers, and went on" : ending.to_string();
}

std::string Child::last_words() const {
  constexpr off_t enough = 400;
  const off_t size = ::lseek(output_, 0, SEEK_END);
  const off_t begin = std::max<off_t>(size - enough, 0);
  std::string text(static_cast<std::size_t>(std::max<off_t>(size - begin, 0)), '\0');
  const ssize_t count = ::pread(output_, text.data(), text.size(), begin);
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

}  // namespace attest
