#include "harness/process/child.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <initializer_list>
#include <new>
#include <optional>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <stdio_ext.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include "harness/core/sanitizers.hpp"

namespace attest {
namespace {

// The file limit also applies to a child's output, which is a file in memory.
constexpr rlim_t max_file_bytes = std::uint64_t{max_file_mib} << 20;
constexpr rlim_t max_memory_bytes = std::uint64_t{max_memory_gib} << 30;

void close_all(std::initializer_list<int> files) {
  for (const int file : files) {
    if (file >= 0) ::close(file);
  }
}

// Sets both limits: the soft one, and the hard one up to which a process can raise the soft one.
void limit(__rlimit_resource resource, rlim_t most) {
  rlimit both{};
  ::getrlimit(resource, &both);
  both.rlim_max = std::min(both.rlim_max, most);
  both.rlim_cur = std::min(both.rlim_cur, both.rlim_max);
  ::setrlimit(resource, &both);
}

// The limit of memory is that of writable memory, which includes all allocations: a port that never
// stops allocating must not use up the memory of the machine. With sanitizers there is no limit, as
// they reserve terabytes.
void limit_code_of_others() {
  if (memory_is_limited()) limit(RLIMIT_DATA, max_memory_bytes);
  limit(RLIMIT_NOFILE, max_open_files);
  limit(RLIMIT_FSIZE, max_file_bytes);
  ::signal(SIGXFSZ, SIG_IGN);  // a write past the limit then fails instead of killing the process
}

// Replaces the parent's input and output, and closes all other files except the child's socket. The
// child must not hold the reports and sockets that the parent has open.
void keep_only(const ChildFiles& files) {
  ::dup2(files.input, STDIN_FILENO);
  ::close(files.input);
  ::dup2(files.output, STDOUT_FILENO);
  ::dup2(files.output, STDERR_FILENO);
  constexpr unsigned first_other = 3;
  const auto kept = static_cast<unsigned>(files.socket);
  if (kept > first_other) ::close_range(first_other, kept - 1, 0);
  ::close_range(kept + 1, ~0u, 0);
}

}  // namespace

bool memory_is_limited() { return !built_with_sanitizers; }

// Neither returns nor throws. The child must not unwind the parent's stack, which owns files to be
// renamed and other children, and must not run the parent's exit handlers.
void run_in_child(const Barrier* barrier, const ChildFiles& files, const Child::Work& work) {
  if (barrier != nullptr) {
    limit_code_of_others();
    barrier->enter();
  }
  keep_only(files);
  ::__fpurge(stdout);                        // what the parent has not yet written
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // last_words() has each line at once
  MessageSocket socket(files.socket);
  try {
    work(socket);
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "out of memory\n");
    std::abort();
  } catch (const std::exception& error) {
    fmt::print(stderr, "uncaught exception: {}\n", error.what());
    std::abort();
  } catch (...) {
    std::abort();
  }
  ::_exit(EXIT_SUCCESS);
}

Result<Child> Child::adopt(const std::function<Result<Process>(const ChildFiles&)>& launch) {
  // All files are opened before the fork, so that a failure is not attributed to the work.
  std::array<int, 2> ends{-1, -1};
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int output = ::memfd_create("attest-child-output", MFD_CLOEXEC);
  if (nothing < 0 || output < 0 ||
      ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    const int reason = errno;
    close_all({nothing, output});
    return fail(fmt::format("cannot open the files of a process: {}{}", std::strerror(reason),
                            reason == EMFILE ? " (`ulimit -n` limits how many are open)" : ""));
  }
  auto process = launch({nothing, output, ends[1]});
  close_all({nothing, ends[1]});
  if (process) return Child(*std::move(process), MessageSocket(ends[0]), output);
  close_all({ends[0], output});
  return tl::unexpected(process.error());
}

Result<Child> Child::spawn(Runs runs, const Work& work, const BarrierOptions& options) {
  std::optional<Barrier> barrier;
  if (runs == Runs::code_of_others) {
    auto made = Barrier::make(options);
    if (!made) return tl::unexpected(made.error());
    barrier.emplace(*std::move(made));
  }
  hide_memory();
  const auto when_stopped = barrier ? Process::WhenStopped::stays : Process::WhenStopped::continues;
  return adopt([&](const ChildFiles& files) {
    return Process::start([&] { run_in_child(barrier ? &*barrier : nullptr, files, work); },
                          when_stopped);
  });
}

Child::Child(Child&& other) noexcept
    : process_(std::move(other.process_)),
      socket_(std::move(other.socket_)),
      output_(std::exchange(other.output_, -1)),
      has_exited_well_(other.has_exited_well_) {}

Child& Child::operator=(Child&& other) noexcept {
  if (this == &other) return *this;
  close_all({output_});
  process_ = std::move(other.process_);
  socket_ = std::move(other.socket_);
  output_ = std::exchange(other.output_, -1);
  has_exited_well_ = other.has_exited_well_;
  return *this;
}

Child::~Child() { close_all({output_}); }

namespace {

// A time limit that also ends the wait when the process has died. Continues a guard that a port has
// stopped, perhaps in the middle of a message of the worker.
class UntilDeath {
 public:
  UntilDeath(Process& process, const Patience& patience) : patience_(patience) {
    patience_.given_up = [this, &process, &patience] {
      if (has_died_) return true;
      // The wait ends only at the next call, because the last message of a dead process may still
      // be unread.
      has_died_ = process.ends_within(0);
      process.wake();
      return patience.given_up();
    };
  }
  UntilDeath(const UntilDeath&) = delete;
  UntilDeath& operator=(const UntilDeath&) = delete;

  const Patience& patience() const { return patience_; }
  Received::Kind resolved(Received::Kind kind) const {
    return kind == Received::Kind::given_up && has_died_ ? Received::Kind::ended : kind;
  }

 private:
  Patience patience_;
  bool has_died_ = false;
};

}  // namespace

Received Child::receive(const Patience& patience) {
  const UntilDeath until_death(process_, patience);
  Received received = socket_.receive(until_death.patience());
  received.kind = until_death.resolved(received.kind);
  return received;
}

Received::Kind Child::receive_blob(void* place, std::size_t size, const Patience& patience) {
  const UntilDeath until_death(process_, patience);
  return until_death.resolved(socket_.receive_blob(place, size, until_death.patience()));
}

std::string Child::end() {
  constexpr double enough_to_end_s = 2;
  const bool was_killed = process_.was_killed();
  const Ending ending = process_.end(enough_to_end_s);
  const bool went_on = ending.was_killed && !was_killed;
  has_exited_well_ = ending.is_success() && !ending.was_killed;
  return went_on ? "closed the socket on which it answers, and went on" : ending.to_string();
}

std::string Child::last_printed() const {
  const std::string words = last_words();
  return words.empty() ? "" : "; it last printed: " + words;
}

std::string last_words_in(std::string_view text) {
  constexpr std::size_t most = 400;
  const auto line_at = [&](std::size_t begin) {
    return text.substr(begin, text.find('\n', begin) - begin);
  };
  const std::size_t end = text.find_last_not_of(" \t\r\n");
  if (end == std::string_view::npos) return "";
  text = text.substr(0, end + 1);
  for (const std::string_view sign :
       {" panicked at ", "panic: ", "ERROR: AddressSanitizer", ": runtime error: "}) {
    const std::size_t found = text.rfind(sign);
    if (found == std::string_view::npos) continue;
    const std::size_t begin = text.substr(0, found).rfind('\n') + 1;  // 0 in the first line
    const std::string_view line = line_at(begin);
    const std::size_t next = begin + line.size() + 1;
    const bool has_message = line.ends_with(':') && next < text.size();  // Rust since 1.73
    const std::string words =
        has_message ? fmt::format("{} {}", line, line_at(next)) : std::string(line);
    return words.substr(0, most);
  }
  const std::string_view last = text.substr(text.rfind('\n') + 1);
  return std::string(last.substr(last.size() - std::min(last.size(), most)));
}

std::size_t Child::printed() const {
  return static_cast<std::size_t>(std::max<off_t>(::lseek(output_, 0, SEEK_END), 0));
}

std::string Child::last_words(std::size_t from) const {
  constexpr std::size_t enough = 16384;  // a panic with its backtrace
  const std::size_t size = printed();
  const std::size_t begin = std::max(size - std::min(size, enough), std::min(size, from));
  std::string text(size - begin, '\0');
  const ssize_t count = ::pread(output_, text.data(), text.size(), static_cast<off_t>(begin));
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  return last_words_in(text);
}

}  // namespace attest
