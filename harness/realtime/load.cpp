#include "harness/realtime/load.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/realtime/program.hpp"

namespace attest {
namespace {

constexpr std::array<std::string_view, 3> names = {"cpu", "cache", "io"};

[[noreturn]] void use_cpu() {
  volatile double value = 1;
  while (true) value = value * 1.0000001 + 1e-9;
}

// Walks through more memory than a cache holds, a line at a time.
[[noreturn]] void use_cache() {
  constexpr std::size_t bytes = 64u << 20, line = 64;
  std::vector<unsigned char> memory(bytes);
  volatile unsigned char* const cells = memory.data();
  while (true) {
    for (std::size_t at = 0; at < bytes; at += line) {
      cells[at] = static_cast<unsigned char>(cells[at] + 1);
    }
  }
}

[[noreturn]] void use_disk() {
  std::FILE* const file = std::tmpfile();
  const std::vector<char> block(1u << 20, 'x');
  while (file != nullptr) {
    std::rewind(file);
    std::fwrite(block.data(), 1, block.size(), file);
    std::fflush(file);
    ::fdatasync(fileno(file));
  }
  use_cpu();
}

[[noreturn]] void use(LoadKind kind) {
  switch (kind) {
    case LoadKind::cache:
      use_cache();
    case LoadKind::io:
      use_disk();
    case LoadKind::cpu:
      break;
  }
  use_cpu();
}

// Of its own process group, so that the workers that stress-ng makes end with it.
template <typename Work>
pid_t start(Work&& work) {
  const pid_t parent = ::getpid();
  std::fflush(nullptr);
  const pid_t process = ::fork();
  if (process > 0) ::setpgid(process, process);  // whoever of the two comes first
  if (process != 0) return process;
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) ::_exit(EXIT_FAILURE);
  work();
  ::_exit(EXIT_FAILURE);
}

[[noreturn]] void become_stress_ng(LoadKind kind, int workers) {
  if (const int nothing = ::open("/dev/null", O_RDWR); nothing >= 0) {
    ::dup2(nothing, STDOUT_FILENO);
    ::dup2(nothing, STDERR_FILENO);
  }
  const std::string option = fmt::format("--{}", name_of(kind));
  const std::string count = fmt::to_string(workers);
  // Its files of --io and --hdd go to the folder for temporary files.
  ::execlp("stress-ng", "stress-ng", option.c_str(), count.c_str(), "--temp-path", "/tmp",
           static_cast<char*>(nullptr));
  ::_exit(EXIT_FAILURE);
}

}  // namespace

std::string_view name_of(LoadKind kind) { return names[static_cast<std::size_t>(kind)]; }

Result<LoadKind> parse_load_kind(std::string_view name) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return static_cast<LoadKind>(i);
  }
  return fail(
      fmt::format("no such kind of load: `{}`; there are {}", name, fmt::join(names, ", ")));
}

Load::Load(LoadKind kind, int workers) {
  if (workers == 0) return;
  const bool has_stress_ng = is_installed("stress-ng");
  if (has_stress_ng) {
    processes_.push_back(start([&] { become_stress_ng(kind, workers); }));
  } else {
    for (int i = 0; i < workers; ++i) processes_.push_back(start([&] { use(kind); }));
  }
  description_ = fmt::format("{} x {} ({})", workers, name_of(kind),
                             has_stress_ng ? "stress-ng" : "own processes");
}

Load::~Load() {
  for (const pid_t process : processes_) ::kill(-process, SIGTERM);
  for (const pid_t process : processes_) {
    while (::waitpid(process, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
}

}  // namespace attest
