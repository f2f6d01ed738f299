#include "harness/process/piped_program.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include "harness/process/program.hpp"

namespace attest {
namespace {

constexpr double time_to_end_s = 1;   // after its stdin was closed
constexpr int look_again_ms = 100;    // period of the check whether the program has ended
constexpr std::size_t chunk = 65536;  // the capacity of a pipe

void close_pipe(std::array<int, 2>& ends) {
  for (const int end : ends) {
    if (end >= 0) ::close(end);
  }
}

}  // namespace

Result<PipedProgram> PipedProgram::start(const std::vector<std::string>& command) {
  std::signal(SIGPIPE, SIG_IGN);
  std::array<int, 2> in{-1, -1}, out{-1, -1};
  if (::pipe2(in.data(), O_CLOEXEC) != 0 || ::pipe2(out.data(), O_CLOEXEC) != 0) {
    const int reason = errno;
    close_pipe(in);
    return fail(fmt::format("cannot open a pipe: {}", std::strerror(reason)));
  }
  auto memory = SharedFrames::make();
  auto process =
      memory ? start_program(
                   command,
                   {.in = in[0], .out = out[1], .error = STDERR_FILENO, .fourth = memory->file()})
             : tl::unexpected(memory.error());
  if (!process) {
    close_pipe(in);
    close_pipe(out);
    return tl::unexpected(process.error());
  }
  ::close(in[0]);
  ::close(out[1]);
  ::fcntl(in[1], F_SETFL, O_NONBLOCK);
  ::fcntl(out[0], F_SETFL, O_NONBLOCK);
  PipedProgram program(*std::move(process), in[1], out[0]);
  program.memory_ = *std::move(memory);
  return program;
}

PipedProgram PipedProgram::recorded(int requests, int answers) { return {{}, requests, answers}; }

PipedProgram::PipedProgram(PipedProgram&& other) noexcept
    : process_(std::move(other.process_)),
      requests_(std::exchange(other.requests_, -1)),
      answers_(std::exchange(other.answers_, -1)),
      inbox_(std::move(other.inbox_)),
      begin_(other.begin_),
      end_(other.end_),
      memory_(std::move(other.memory_)),
      is_shared_(other.is_shared_) {}

PipedProgram::~PipedProgram() { end(); }

bool PipedProgram::share_memory() { return is_shared_ = memory_.has_value(); }

bool PipedProgram::write(std::string_view bytes) {
  return is_shared_ ? memory_->write(bytes) : write_to_pipe(bytes);
}

bool PipedProgram::read(void* place, std::size_t size) {
  if (!is_shared_) return read_from_pipe(place, size);
  return memory_->read(place, size, [&] { return process_.ends_within(0); });
}

bool PipedProgram::write_to_pipe(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(requests_, bytes.data(), bytes.size());
    if (written >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno == EAGAIN) {
      std::array<pollfd, 2> either{{{requests_, POLLOUT, 0}, {answers_, POLLIN, 0}}};
      ::poll(either.data(), either.size(), look_again_ms);
      if ((either[1].revents & POLLIN) != 0 && !receive()) return false;
      if (process_.ends_within(0)) return false;
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

bool PipedProgram::receive() {
  if (begin_ == end_) begin_ = end_ = 0;
  if (inbox_.size() < end_ + chunk) inbox_.resize(2 * (end_ + chunk));
  bool has_ended = false;
  while (true) {
    pollfd readable{answers_, POLLIN, 0};
    const int is_readable = ::poll(&readable, 1, has_ended ? 0 : look_again_ms);
    if (is_readable > 0) {
      const ssize_t count = ::read(answers_, inbox_.data() + end_, chunk);
      if (count > 0) end_ += static_cast<std::size_t>(count);
      if (count >= 0 || (errno != EAGAIN && errno != EINTR)) return count > 0;
    } else if (is_readable == 0) {
      if (has_ended) return false;  // the program's children may keep the pipe open
      has_ended = process_.ends_within(0);
    }
  }
}

bool PipedProgram::read_from_pipe(void* place, std::size_t size) {
  while (end_ - begin_ < size) {
    if (!receive()) return false;
  }
  std::memcpy(place, inbox_.data() + begin_, size);
  begin_ += size;
  return true;
}

std::optional<std::string> PipedProgram::read_line(std::size_t most) {
  std::size_t searched = 0;
  while (true) {
    const std::string_view text = unread();
    if (const std::size_t end = text.find('\n', searched); end != std::string_view::npos) {
      if (end > most) return std::nullopt;
      std::string line(text.substr(0, end));
      begin_ += end + 1;
      return line;
    }
    searched = text.size();
    if (searched > most || !receive()) return std::nullopt;
  }
}

std::string PipedProgram::end() {
  if (requests_ < 0) return "has ended";
  ::close(std::exchange(requests_, -1));
  ::close(std::exchange(answers_, -1));
  const Ending ending = process_.end(time_to_end_s);
  return ending.was_killed ? "closed its stdout" : ending.to_string();
}

}  // namespace attest
