#include "harness/process/process.hpp"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "harness/process/happens_within.hpp"
#include "harness/process/orphans.hpp"
#include "harness/process/signals.hpp"

namespace attest {
namespace {

// Called in a new child, which owns no process. Its copy of the lock is locked: the parent held the
// lock while it forked.
void own_nothing() {
  owned().processes.clear();
  owned().mutex.unlock();
}

[[noreturn]] void lead_group(pid_t parent, const std::function<void()>& work) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(EXIT_FAILURE);  // the parent died before prctl()
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  reset_signals();
  work();
  ::_exit(EXIT_SUCCESS);
}

void reap(pid_t process, Ending& ending) {
  int status = 0;
  const bool has_ended = happens_within(
      time_to_die_s, [&] { return ::waitpid(process, &status, WNOHANG) == process; });
  if (has_ended) ending.wait_status = status;
}

// ---- the guard ----------------------------------------------------------------------------------

// True in a process below a guard.
bool is_guarded = false;

// The guard is the parent of the child process, and of all descendants that have lost their
// parents. It has a group of its own, so it does not get the signals that the child process sends
// to its group. All signals of the guard are blocked. It waits for SIGCHLD, for SIGTERM, which it
// passes on to the child's group, and for SIGHUP: the owner asks for the end, or has died.
constexpr int end_all = SIGHUP;

// Waits for the end of `leader`, the child process. Empty: the caller must end `leader`.
std::optional<int> status_of(pid_t leader, pid_t owner, Process::WhenStopped when_stopped) {
  sigset_t taken;
  ::sigemptyset(&taken);
  for (const int signal : {SIGCHLD, SIGTERM, end_all}) ::sigaddset(&taken, signal);
  int signal = 0;
  while (signal != end_all && ::getppid() == owner) {
    int status = 0;
    for (pid_t child = 0; (child = ::waitpid(-1, &status, WNOHANG | WUNTRACED)) > 0;) {
      if (child != leader) continue;
      if (!WIFSTOPPED(status)) return status;
      if (when_stopped == Process::WhenStopped::continues) ::kill(leader, SIGCONT);
    }
    signal = ::sigwaitinfo(&taken, nullptr);
    if (signal == SIGTERM) ::kill(-leader, SIGTERM);
  }
  return std::nullopt;
}

// Ends the guard in the same way as its child process ended, so that the owner sees how.
[[noreturn]] void end_as(const Ending& ending) {
  if (ending.wait_status && WIFEXITED(*ending.wait_status)) {
    ::_exit(WEXITSTATUS(*ending.wait_status));
  }
  const int signal = ending.wait_status ? WTERMSIG(*ending.wait_status) : SIGKILL;
  ::prctl(PR_SET_DUMPABLE, 0);  // the guard leaves no core file
  std::signal(signal, SIG_DFL);
  sigset_t only;
  ::sigemptyset(&only);
  ::sigaddset(&only, signal);
  ::raise(signal);
  ::pthread_sigmask(SIG_UNBLOCK, &only, nullptr);
  ::_exit(EXIT_FAILURE);  // not reached
}

// Writes to `ready` the errno of fork(), or 0 when the child process can be sent signals.
[[noreturn]] void guard(pid_t owner, int ready, const std::function<void()>& work,
                        Process::WhenStopped when_stopped, const std::function<void()>& at_end) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, end_all);
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  if (::getppid() != owner) ::_exit(EXIT_FAILURE);  // the owner died before prctl()
  std::signal(SIGCHLD, SIG_DFL);
  const pid_t self = ::getpid(), leader = ::fork();
  if (leader == 0) {
    ::close(ready);
    is_guarded = true;
    lead_group(self, work);
  }
  const int reason = leader > 0 ? 0 : errno;
  if (leader > 0) ::setpgid(leader, leader);  // lead_group() does the same, perhaps later
  const bool is_told = ::write(ready, &reason, sizeof reason) == sizeof reason;
  // The guard must not keep open a pipe whose end of file another process waits for.
  ::close_range(0, ~0u, 0);
  if (leader < 0 || !is_told) ::_exit(EXIT_FAILURE);
  Ending ending;
  ending.wait_status = status_of(leader, owner, when_stopped);
  if (!ending.wait_status) {
    ::kill(leader, SIGKILL);
    reap(leader, ending);
  }
  end_orphans();
  at_end();
  end_as(ending);
}

// Returns the id of the guard when it has forked the child process. -1: errno has the reason.
pid_t start_guarded(const std::function<void()>& work, Process::WhenStopped when_stopped,
                    const std::function<void()>& at_end) {
  const pid_t owner = ::getpid();
  std::array<int, 2> ready{-1, -1};
  if (::pipe2(ready.data(), O_CLOEXEC) != 0) return -1;
  const pid_t started = ::fork();
  if (started == 0) {
    own_nothing();
    ::close(ready[0]);
    guard(owner, ready[1], work, when_stopped, at_end);
  }
  int reason = errno;
  ::close(ready[1]);
  if (started > 0 && ::read(ready[0], &reason, sizeof reason) != sizeof reason) reason = ECHILD;
  ::close(ready[0]);
  if (started > 0 && reason != 0) ::waitpid(started, nullptr, 0);
  errno = reason;
  return started > 0 && reason == 0 ? started : -1;
}

pid_t start_alone(const std::function<void()>& work) {
  const pid_t owner = ::getpid(), started = ::fork();
  if (started == 0) {
    own_nothing();
    lead_group(owner, work);
  }
  return started;
}

}  // namespace

Result<Process> Process::start(const std::function<void()>& work, WhenStopped when_stopped,
                               const std::function<void()>& at_end) {
  // Otherwise a child that calls exit() would print the unflushed output of the parent, too.
  std::fflush(nullptr);
  if (is_guarded) return adopt([&] { return start_alone(work); });
  auto started = adopt([&] { return start_guarded(work, when_stopped, at_end); });
  if (started) started->has_guard_ = true;
  return started;
}

Result<Process> Process::adopt(const std::function<pid_t()>& fork) {
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  pid_t started = -1;
  int reason = 0;
  // On a machine under load, other processes may end and leave room within these seconds.
  constexpr double patience_s = 10;
  happens_within(patience_s, [&] {
    const SignalsBlocked blocked;
    const std::lock_guard lock(owned().mutex);
    started = fork();
    reason = errno;
    if (started > 0) {
      ::setpgid(started, started);  // lead_group() does the same, perhaps later
      owned().processes.insert(started);
    }
    return started > 0 || (reason != EAGAIN && reason != ENOMEM);
  });
  if (started > 0) return Process(started);
  return fail(fmt::format("cannot start a process: {}{}", std::strerror(reason),
                          reason == EAGAIN ? " (`ulimit -u` limits how many there are)" : ""));
}

namespace {

struct Forked {
  pid_t child = -1;
  int reason = 0;  // errno, if there is no child
};

// The process between this one and the child process. It shares the memory of this process, which
// waits until it ends (vfork): a second copy of the page tables would double the time of a launch.
[[gnu::noinline]] void fork_from_between(pid_t owner, const std::function<void()>& work,
                                         Forked& forked) {
  const pid_t child = ::fork();
  if (child == 0) {
    own_nothing();
    happens_within(time_to_die_s, [&] { return ::getppid() == owner; });
    lead_group(owner, work);
  }
  forked = {child, errno};
  ::_exit(EXIT_SUCCESS);
}

}  // namespace

pid_t fork_sibling(const std::function<void()>& work) {
  std::fflush(nullptr);
  const SignalsBlocked blocked;
  const std::lock_guard lock(owned().mutex);
  const pid_t owner = ::getppid();
  Forked forked;
  const pid_t between = ::vfork();
  if (between == 0) fork_from_between(owner, work, forked);
  if (between < 0) return -1;
  ::waitpid(between, nullptr, 0);  // now the owner is the parent of the child process
  errno = forked.reason;
  return forked.child;
}

bool is_below_guard() { return is_guarded; }

Process::Process(Process&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      has_guard_(other.has_guard_),
      was_killed_(other.was_killed_) {}

Process& Process::operator=(Process&& other) noexcept {
  if (this == &other) return *this;
  end(0);
  pid_ = std::exchange(other.pid_, -1);
  has_guard_ = other.has_guard_;
  was_killed_ = other.was_killed_;
  return *this;
}

Process::~Process() { end(0); }

bool Process::ends_within(double seconds) {
  return pid_ <= 0 || happens_within(seconds, [&] {
           siginfo_t info{};
           const auto id = static_cast<id_t>(pid_);
           const int waited = ::waitid(P_PID, id, &info, WEXITED | WNOHANG | WNOWAIT);
           return (waited != 0 && errno != EINTR) || info.si_pid != 0;
         });
}

void Process::wake() {
  siginfo_t info{};
  if (!has_guard_ || pid_ <= 0) return;
  if (::waitid(P_PID, static_cast<id_t>(pid_), &info, WSTOPPED | WNOHANG) != 0) return;
  if (info.si_pid != 0) ::kill(pid_, SIGCONT);
}

void Process::terminate() {
  if (pid_ > 0) ::kill(-pid_, SIGTERM);
}

void Process::kill() {
  if (pid_ <= 0) return;
  was_killed_ = true;
  if (has_guard_) {
    // Not SIGKILL: the guard must end daemons even if this process is killed now.
    ::kill(pid_, end_all);
    ::kill(pid_, SIGCONT);  // a port may have stopped the guard
  } else {
    ::kill(-pid_, SIGKILL);
    ::kill(pid_, SIGKILL);  // the process may have moved to another group
  }
}

Ending Process::end(double patience_s) {
  Ending ending;
  if (pid_ <= 0) return ending;
  if (!ends_within(patience_s)) kill();
  ending.was_killed = was_killed_;
  // Before reap(), because after it another process group may get this id.
  if (!has_guard_) ::kill(-pid_, SIGKILL);
  reap(pid_, ending);
  if (!ending.wait_status) {  // a guard that was stopped (SIGSTOP) does not end itself
    ::kill(pid_, SIGKILL);
    reap(pid_, ending);
  }
  {
    const std::lock_guard lock(owned().mutex);
    owned().processes.erase(std::exchange(pid_, -1));
  }
  end_orphans();
  return ending;
}

Ending Process::stop(double grace_s) {
  terminate();
  return end(grace_s);
}

}  // namespace attest
