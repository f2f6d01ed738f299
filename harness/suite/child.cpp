#include "harness/suite/child.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace attest {
namespace {

// A port that prints at every step must not fill the machine's memory.
constexpr rlim_t max_output_bytes = 16u << 20;

void write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) ::_exit(EXIT_FAILURE);  // the parent is gone
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

// Everything a child must have arranged before it runs code of others.
void isolate(pid_t parent, int output) {
  ::setpgid(0, 0);  // what a port starts ends with it
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(EXIT_FAILURE);  // it died before the line above
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  rlimit files{};
  ::getrlimit(RLIMIT_FSIZE, &files);
  files.rlim_cur = std::min(files.rlim_max, max_output_bytes);
  ::setrlimit(RLIMIT_FSIZE, &files);
  ::signal(SIGTERM, SIG_DFL);  // the parent's handler would pass over a port that raises it
  ::signal(SIGXFSZ, SIG_IGN);  // writing past the limit fails, it does not kill
  ::signal(SIGINT, SIG_IGN);   // Ctrl-C is the parent's to handle
  if (const int nothing = ::open("/dev/null", O_RDONLY); nothing >= 0) {
    ::dup2(nothing, STDIN_FILENO);
    ::close(nothing);
  }
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
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

void allow_large_files() {
  rlimit files{};
  ::getrlimit(RLIMIT_FSIZE, &files);
  files.rlim_cur = files.rlim_max;
  ::setrlimit(RLIMIT_FSIZE, &files);
}

Result<Child> Child::spawn(const std::function<void(const SendLine&)>& work) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    return fail(fmt::format("cannot make a pipe: {}", std::strerror(errno)));
  }
  const int output = ::memfd_create("attest-port-output", MFD_CLOEXEC);
  const pid_t parent = ::getpid();
  // A port that calls exit() would print what the parent has not printed yet.
  std::fflush(nullptr);
  const pid_t pid = output < 0 ? -1 : ::fork();
  if (pid < 0) {
    const int reason = errno;
    for (const int descriptor : {ends[0], ends[1], output}) ::close(descriptor);
    return fail(fmt::format("cannot start a worker process: {}", std::strerror(reason)));
  }
  if (pid == 0) {
    ::close(ends[0]);
    isolate(parent, output);
    work_and_end(work, ends[1]);
  }
  ::setpgid(pid, pid);  // here too: whichever of us is first
  ::close(ends[1]);
  return Child(pid, ends[0], output);
}

Child::Child(Child&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      pipe_(std::exchange(other.pipe_, -1)),
      output_(std::exchange(other.output_, -1)),
      partial_(std::move(other.partial_)),
      was_killed_(other.was_killed_) {}

Child& Child::operator=(Child&& other) noexcept {
  if (this == &other) return *this;
  release();
  pid_ = std::exchange(other.pid_, -1);
  pipe_ = std::exchange(other.pipe_, -1);
  output_ = std::exchange(other.output_, -1);
  partial_ = std::move(other.partial_);
  was_killed_ = other.was_killed_;
  return *this;
}

Child::~Child() { release(); }

void Child::release() {
  kill();
  if (pid_ > 0) end();
  if (pipe_ >= 0) ::close(pipe_);
  if (output_ >= 0) ::close(output_);
}

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

std::optional<std::string> Child::wait_for_line(double timeout_s) {
  pollfd readable{pipe_, POLLIN, 0};
  bool ended = false;
  while (!ended && ::poll(&readable, 1, static_cast<int>(timeout_s * 1000)) > 0) {
    const auto lines = read_lines(ended);
    if (!lines.empty()) return lines.front();
  }
  if (!ended) kill();
  return std::nullopt;
}

void Child::kill() {
  if (pid_ <= 0) return;
  was_killed_ = true;
  ::kill(-pid_, SIGKILL);
  ::kill(pid_, SIGKILL);
}

bool Child::ends_within(double seconds) {
  constexpr int poll_ms = 2;
  for (int left = static_cast<int>(seconds * 1000); pid_ > 0 && left > 0; left -= poll_ms) {
    siginfo_t info{};
    const int waited = ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT);
    if (waited != 0 || info.si_pid != 0) return true;
    ::poll(nullptr, 0, poll_ms);
  }
  return pid_ <= 0;
}

void Child::ask_to_stop() {
  if (pid_ > 0) ::kill(pid_, SIGTERM);
}

std::string Child::end() {
  int status = 0;
  siginfo_t info{};
  while (pid_ > 0 && ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOWAIT) < 0 &&
         errno == EINTR) {
  }
  // What it started, while its number cannot be another's yet.
  if (pid_ > 0) ::kill(-pid_, SIGKILL);
  while (pid_ > 0 && ::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  if (WIFSIGNALED(status)) {
    const int signal = WTERMSIG(status);
    return fmt::format("was killed by signal {} ({})", signal, ::strsignal(signal));
  }
  return fmt::format("exited with status {}", WEXITSTATUS(status));
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
