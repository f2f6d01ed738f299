#include "harness/process/process.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace attest {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

// The kernel ends a killed process immediately, unless the process waits for a device.
constexpr double time_to_die_s = 5;

// Polls `happened`, at first with short pauses, because most processes end within a millisecond.
template <typename Happened>
bool happens_within(double seconds, Happened&& happened) {
  const auto deadline = Clock::now() + std::chrono::duration<double>(seconds);
  for (Clock::duration pause = 50us; !happened();
       pause = std::min<Clock::duration>(2 * pause, 5ms)) {
    if (Clock::now() >= deadline) return false;
    std::this_thread::sleep_for(pause);
  }
  return true;
}

// Between fork() and the reset of the handlers, a handler of the parent must not run in the child.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_{};
};

// The handlers of these signals stay, because the sanitizers report errors with them.
bool is_of_an_error(int signal) {
  return signal == SIGSEGV || signal == SIGBUS || signal == SIGFPE || signal == SIGILL ||
         signal == SIGABRT || signal == SIGTRAP;
}

void reset_signals() {
  for (int signal = 1; signal < NSIG; ++signal) {
    if (!is_of_an_error(signal)) std::signal(signal, SIG_DFL);
  }
  sigset_t none;
  ::sigemptyset(&none);
  ::pthread_sigmask(SIG_SETMASK, &none, nullptr);
}

// The processes that have an owner. All other children are orphans: a process of this list started
// them and ended before them. Locked while a child exists that is not in the list yet.
struct Owned {
  std::mutex mutex;
  std::set<pid_t> processes;
};

Owned& owned() {
  static Owned all;
  return all;
}

// For a child: it owns no process, and it was forked while the lock was held.
void own_nothing() {
  owned().processes.clear();
  owned().mutex.unlock();
}

// Both ends of the pipe on which the guard reports that it has joined the group.
using Ready = std::array<int, 2>;

[[noreturn]] void lead_group(pid_t parent, const Ready& ready, const std::function<void()>& work) {
  own_nothing();
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(EXIT_FAILURE);  // it died before the line above
  // Waits for the guard. Without it, processes started now would outlive a parent that dies now.
  ::close(ready[1]);
  char byte = 0;
  if (::read(ready[0], &byte, 1) != 1) ::_exit(EXIT_FAILURE);
  ::close(ready[0]);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  reset_signals();
  work();
  ::_exit(EXIT_SUCCESS);
}

// The leader itself gets PR_SET_PDEATHSIG, but what it starts does not. The guard is in the group,
// with all signals blocked, so that only SIGKILL to the group or the death of the parent ends it.
[[noreturn]] void guard_group(pid_t parent, const Ready& ready, pid_t leader) {
  ::prctl(PR_SET_PDEATHSIG, SIGHUP);
  if (::setpgid(0, leader) != 0 || ::write(ready[1], "", 1) != 1) ::_exit(EXIT_FAILURE);
  // It must not keep open a pipe whose end of file another process waits for.
  ::close_range(0, ~0u, 0);
  sigset_t death_of_parent;
  ::sigemptyset(&death_of_parent);
  ::sigaddset(&death_of_parent, SIGHUP);
  while (::getppid() == parent) ::sigwaitinfo(&death_of_parent, nullptr);
  ::kill(-leader, SIGKILL);
  ::_exit(EXIT_SUCCESS);
}

void reap(pid_t process, Ending& ending) {
  int status = 0;
  const bool has_ended = happens_within(
      time_to_die_s, [&] { return ::waitpid(process, &status, WNOHANG) == process; });
  if (has_ended) ending.wait_status = status;
}

std::vector<pid_t> children() {
  std::vector<pid_t> found;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
    std::ifstream list(task.path() / "children");
    for (pid_t child = 0; list >> child;) found.push_back(child);
  }
  return found;
}

void end_orphans() {
  Owned& all = owned();
  const std::lock_guard lock(all.mutex);
  // When an orphan ends, its own children become orphans.
  constexpr int generations = 100;
  for (int i = 0; i < generations; ++i) {
    std::vector<pid_t> orphans = children();
    std::erase_if(orphans, [&](pid_t child) { return all.processes.contains(child); });
    if (orphans.empty()) return;
    for (const pid_t orphan : orphans) {
      ::kill(orphan, SIGKILL);
      Ending ignored;
      reap(orphan, ignored);
    }
  }
}

}  // namespace

bool Ending::is_success() const {
  return wait_status && WIFEXITED(*wait_status) && WEXITSTATUS(*wait_status) == EXIT_SUCCESS;
}

std::string Ending::to_string() const {
  if (!wait_status) return fmt::format("did not end within {} s of SIGKILL", time_to_die_s);
  if (WIFSIGNALED(*wait_status)) {
    const int signal = WTERMSIG(*wait_status);
    return fmt::format("was killed by signal {} ({})", signal, ::strsignal(signal));
  }
  return fmt::format("exited with status {}", WEXITSTATUS(*wait_status));
}

Result<Process> Process::start(const std::function<void()>& work, bool with_guard) {
  const pid_t parent = ::getpid();
  // Otherwise a child that calls exit() would print the unflushed output of the parent, too.
  std::fflush(nullptr);
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);
  const SignalsBlocked blocked;
  const std::lock_guard lock(owned().mutex);
  Ready ready{-1, -1};
  const bool has_pipe = ::pipe2(ready.data(), O_CLOEXEC) == 0;
  const pid_t leader = has_pipe ? ::fork() : -1;
  if (leader == 0) lead_group(parent, ready, work);
  if (leader > 0) ::setpgid(leader, leader);  // here too: the first of the two calls decides
  const pid_t guard = leader > 0 && with_guard ? ::fork() : -1;
  if (guard == 0) guard_group(parent, ready, leader);
  const int reason = errno;
  const bool is_released = !with_guard && leader > 0 && ::write(ready[1], "", 1) == 1;
  for (const int end : ready) {
    if (end >= 0) ::close(end);
  }
  if (leader > 0) owned().processes.insert(leader);
  if (guard > 0) owned().processes.insert(guard);
  if (guard > 0 || is_released) return Process(leader, guard);
  if (leader > 0) {
    ::kill(leader, SIGKILL);
    Ending ignored;
    reap(leader, ignored);
    owned().processes.erase(leader);
  }
  return fail(fmt::format("cannot start a process: {}{}", std::strerror(reason),
                          reason == EAGAIN ? " (`ulimit -u` limits how many there are)" : ""));
}

Process::Process(Process&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      guard_(std::exchange(other.guard_, -1)),
      was_killed_(other.was_killed_) {}

Process& Process::operator=(Process&& other) noexcept {
  if (this == &other) return *this;
  end(0);
  pid_ = std::exchange(other.pid_, -1);
  guard_ = std::exchange(other.guard_, -1);
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

void Process::terminate() {
  if (pid_ > 0) ::kill(-pid_, SIGTERM);
}

void Process::kill() {
  if (pid_ <= 0) return;
  was_killed_ = true;
  ::kill(-pid_, SIGKILL);
  ::kill(pid_, SIGKILL);  // it may have moved to another group
}

Ending Process::end(double patience_s) {
  Ending ending;
  if (pid_ <= 0) return ending;
  if (!ends_within(patience_s)) kill();
  ending.was_killed = was_killed_;
  // Kills the group before reap(): until then no other process can get this number.
  ::kill(-pid_, SIGKILL);
  reap(pid_, ending);
  if (guard_ > 0) {
    ::kill(guard_, SIGKILL);  // it may not have joined the group yet
    Ending ignored;
    reap(guard_, ignored);
  }
  {
    const std::lock_guard lock(owned().mutex);
    owned().processes.erase(std::exchange(pid_, -1));
    owned().processes.erase(std::exchange(guard_, -1));
  }
  end_orphans();
  return ending;
}

Ending Process::stop(double grace_s) {
  terminate();
  return end(grace_s);
}

}  // namespace attest
