#include "harness/process/program.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

namespace attest {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t max_output_bytes = 16u << 20;
constexpr double grace_s = 1;      // between SIGTERM and SIGKILL
constexpr int look_every_ms = 20;  // period of the checks whether it has ended or must stop

constexpr int cannot_be_executed = 127;  // the exit status that shells use

bool may_be_executed(const std::string& file) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(file, ignored) && ::access(file.c_str(), X_OK) == 0;
}

// Replaces the calling child process by the program.
[[noreturn]] void become(const std::vector<char*>& arguments, const ProgramFiles& files) {
  const int nothing = ::open("/dev/null", O_RDWR);
  const auto given = [&](int descriptor) { return descriptor >= 0 ? descriptor : nothing; };
  ::dup2(given(files.in), STDIN_FILENO);
  ::dup2(given(files.out), STDOUT_FILENO);
  ::dup2(given(files.error), STDERR_FILENO);
  constexpr int fourth = STDERR_FILENO + 1;
  // dup2() to the same descriptor would leave it marked to be closed at exec.
  if (files.fourth == fourth) {
    ::fcntl(fourth, F_SETFD, 0);
  } else if (files.fourth >= 0) {
    ::dup2(files.fourth, fourth);
  }
  ::close_range(files.fourth >= 0 ? fourth + 1 : fourth, ~0u, 0);
  ::execvp(arguments[0], arguments.data());
  ::_exit(cannot_be_executed);
}

double seconds_until(Clock::time_point deadline) {
  return std::max(std::chrono::duration<double>(deadline - Clock::now()).count(), 0.0);
}

// Reads until the program has closed the pipe or has ended, because its children may keep the pipe
// open. Empty: the program did not stay within the limits.
std::optional<std::string> read_all(int pipe, Process& program, Clock::time_point deadline,
                                    const ProgramLimits& limits) {
  std::string text;
  std::array<char, 65536> buffer;
  while (Clock::now() < deadline && !limits.stop() && text.size() <= max_output_bytes) {
    const bool has_ended = program.ends_within(0);
    pollfd readable{pipe, POLLIN, 0};
    if (::poll(&readable, 1, has_ended ? 0 : look_every_ms) <= 0) {
      if (has_ended) return text;
      continue;
    }
    const ssize_t count = ::read(pipe, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> find_program(const std::string& program) {
  if (program.find('/') != std::string::npos) {
    return may_be_executed(program) ? std::optional(program) : std::nullopt;
  }
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (std::string file = folder + "/" + program; may_be_executed(file)) return file;
  }
  return std::nullopt;
}

bool is_installed(const std::string& program) { return find_program(program).has_value(); }

Result<Process> start_program(const std::vector<std::string>& command, const ProgramFiles& files) {
  std::vector<char*> arguments;  // execvp() does not write to them
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  return Process::start([&] { become(arguments, files); });
}

std::optional<std::string> output_of(const std::vector<std::string>& command,
                                     const ProgramLimits& limits) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return std::nullopt;
  const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                           std::chrono::duration<double>(limits.timeout_s));
  auto program = start_program(command, {.out = ends[1]});
  ::close(ends[1]);
  std::optional<std::string> output;
  if (program) output = read_all(ends[0], *program, deadline, limits);
  ::close(ends[0]);
  if (!program) return std::nullopt;
  const Ending ending = output ? program->end(seconds_until(deadline)) : program->stop(grace_s);
  return ending.is_success() ? output : std::nullopt;
}

}  // namespace attest
