// What a child process inherits, how it ends, and what it leaves behind.
#include "harness/process/process.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace attest {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr int patience_ms = 60'000;  // no test waits so long

// A pipe that stays open while one of the processes that inherited it lives.
class Alive {
 public:
  Alive() {
    if (::pipe(ends_.data()) != 0) std::abort();
  }
  ~Alive() {
    for (const int end : ends_) ::close(end);
  }

  // Called in a process that lives.
  void say_so() const { static_cast<void>(!::write(ends_[1], "x", 1)); }

  // Whether `count` processes have called say_so().
  bool are_alive(int count) const {
    char byte = 0;
    for (int i = 0; i < count; ++i) {
      pollfd readable{ends_[0], POLLIN, 0};
      if (::poll(&readable, 1, patience_ms) <= 0 || ::read(ends_[0], &byte, 1) != 1) return false;
    }
    return true;
  }

  // Whether all processes that held the pipe have ended.
  bool are_gone() {
    ::close(std::exchange(ends_[1], -1));
    pollfd readable{ends_[0], POLLIN, 0};
    char byte = 0;
    return ::poll(&readable, 1, patience_ms) > 0 && ::read(ends_[0], &byte, 1) == 0;
  }

 private:
  std::array<int, 2> ends_{};
};

[[noreturn]] void stay() {
  while (true) ::pause();
}

[[noreturn]] void stay_whatever_comes(const Alive& alive) {
  for (const int signal : {SIGTERM, SIGHUP, SIGINT}) std::signal(signal, SIG_IGN);
  alive.say_so();
  stay();
}

// Two processes of one group.
[[noreturn]] void stay_with_another(const Alive& alive) {
  if (::fork() == 0) stay_whatever_comes(alive);
  stay_whatever_comes(alive);
}

Process started(const std::function<void()>& work) {
  auto process = Process::start(work);
  if (!process) {
    ADD_FAILURE() << process.error().to_string();
    std::abort();
  }
  return *std::move(process);
}

void pass_over(int) {}

TEST(Process, SaysHowItEnded) {
  EXPECT_TRUE(started([] {}).end(60).is_success());
  const Ending exit = started([] { ::_exit(3); }).end(60);
  EXPECT_EQ(exit.to_string(), "exited with status 3");
  EXPECT_FALSE(exit.is_success());
  EXPECT_FALSE(exit.was_killed);
  const Ending crash = started([] { ::raise(SIGTERM); }).end(60);
  EXPECT_EQ(crash.to_string(), "was killed by signal 15 (Terminated)");
  EXPECT_FALSE(crash.was_killed);
}

TEST(Process, ThatCannotBeStartedIsAnErrorWithTheLimit) {
  constexpr uid_t nobody = 65534;
  constexpr int other_user_refused = 2;
  const pid_t limited = ::fork();
  if (limited == 0) {
    // The limit does not apply to root.
    if (::getuid() == 0 && ::setuid(nobody) != 0) ::_exit(other_user_refused);
    const rlimit none{0, 0};
    ::setrlimit(RLIMIT_NPROC, &none);
    const auto process = Process::start([] {});
    const bool said = !process && process.error().message.find("`ulimit -u`") != std::string::npos;
    ::_exit(said ? EXIT_SUCCESS : EXIT_FAILURE);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(limited, &status, 0), limited);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == other_user_refused) GTEST_SKIP() << "root cannot be another user";
  EXPECT_EQ(WEXITSTATUS(status), EXIT_SUCCESS);
}

TEST(Process, ContinuesWhenItIsStoppedIfItIsStartedSo) {
  const auto stop_myself = [] { ::raise(SIGSTOP); };
  auto continues = Process::start(stop_myself, Process::WhenStopped::continues);
  ASSERT_TRUE(continues);
  EXPECT_TRUE(continues->end(60).is_success());
  auto stays = Process::start(stop_myself);
  ASSERT_TRUE(stays);
  EXPECT_FALSE(stays->ends_within(0.1));
  EXPECT_TRUE(stays->end(0).was_killed);
}

TEST(Process, WakesItsGuard) {
  std::array<int, 2> go{-1, -1};
  ASSERT_EQ(::pipe(go.data()), 0);
  const auto stop_both = [&] {
    char begin = 0;
    if (::read(go[0], &begin, 1) != 1) ::_exit(EXIT_FAILURE);
    ::kill(::getppid(), SIGSTOP);
    ::raise(SIGSTOP);
  };
  auto process = Process::start(stop_both, Process::WhenStopped::continues);
  ASSERT_TRUE(process);
  EXPECT_EQ(::write(go[1], "x", 1), 1);  // start() has returned, so it does not need the guard
  EXPECT_FALSE(process->ends_within(0.1));
  for (int i = 0; i < 1000 && !process->ends_within(0.01); ++i) process->wake();
  EXPECT_TRUE(process->end(0).is_success());
  for (const int end : go) ::close(end);
}

TEST(Process, IsNotWaitedForBeyondTheLimit) {
  Process process = started(stay);
  EXPECT_FALSE(process.ends_within(0.01));
  const Ending ending = process.end(0.01);
  EXPECT_TRUE(ending.was_killed);
  EXPECT_EQ(ending.to_string(), "was killed by signal 9 (Killed)");
  EXPECT_EQ(process.pid(), -1);
}

TEST(Process, ThatIgnoresSigtermIsKilledAfterTheGracePeriod) {
  const Alive alive;
  Process process = started([&] { stay_whatever_comes(alive); });
  ASSERT_TRUE(alive.are_alive(1));
  const auto begin = Clock::now();
  const Ending ending = process.stop(0.2);
  EXPECT_GE(Clock::now() - begin, 200ms);
  EXPECT_TRUE(ending.was_killed);
  EXPECT_EQ(ending.to_string(), "was killed by signal 9 (Killed)");
}

// The command line's handlers only record SIGINT and SIGTERM: a child with these handlers would go
// on.
TEST(Process, DoesNotHaveTheHandlersAndMaskOfItsParent) {
  const auto before = std::signal(SIGTERM, pass_over);
  sigset_t mask;
  ::sigemptyset(&mask);
  ::sigaddset(&mask, SIGTERM);
  ::sigprocmask(SIG_BLOCK, &mask, nullptr);
  Process process = started(stay);
  const Ending ending = process.stop(60);
  ::sigprocmask(SIG_UNBLOCK, &mask, nullptr);
  std::signal(SIGTERM, before);
  EXPECT_FALSE(ending.was_killed);
  EXPECT_EQ(ending.to_string(), "was killed by signal 15 (Terminated)");
}

TEST(Process, WhatItStartedEndsWithIt) {
  Alive alive;
  Process process = started([&] { stay_with_another(alive); });
  ASSERT_TRUE(alive.are_alive(2));
  process.stop(0);
  EXPECT_TRUE(alive.are_gone());
}

TEST(Process, WhatItLeftBehindEndsWhenItHasEnded) {
  Alive alive;
  Process process = started([&] {
    if (::fork() == 0) stay_whatever_comes(alive);
    if (!alive.are_alive(1)) ::_exit(EXIT_FAILURE);
  });
  EXPECT_TRUE(process.end(60).is_success());
  EXPECT_TRUE(alive.are_gone());
}

// A library that makes itself a daemon does this.
TEST(Process, WhatItStartedInASessionOfItsOwnEndsToo) {
  Process other = started(stay);
  Alive alive;
  Process process = started([&] {
    if (::fork() == 0) {
      ::setsid();
      if (::fork() == 0) stay_whatever_comes(alive);
      stay_whatever_comes(alive);
    }
    stay();
  });
  ASSERT_TRUE(alive.are_alive(2));
  process.stop(0);
  EXPECT_TRUE(alive.are_gone());
  EXPECT_FALSE(other.ends_within(0.05));
}

// The case of an attest that is killed itself.
TEST(Process, ItAndWhatItStartedEndWithItsParent) {
  Alive alive;
  const pid_t parent = ::fork();
  if (parent == 0) {
    std::signal(SIGTERM, pass_over);
    const auto process = Process::start([&] { stay_with_another(alive); });
    stay();
  }
  const bool were_alive = alive.are_alive(2);
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
  EXPECT_TRUE(were_alive);
  EXPECT_TRUE(alive.are_gone());
}

// A process in a session of its own whose parent has ended, as a daemon.
[[noreturn]] void stay_with_a_daemon(const Alive& alive) {
  if (::fork() == 0) {
    ::setsid();
    if (::fork() == 0) stay_whatever_comes(alive);
    ::_exit(EXIT_SUCCESS);
  }
  stay_whatever_comes(alive);
}

TEST(Process, ItsDaemonsEndWithItsParent) {
  Alive alive;
  const pid_t parent = ::fork();
  if (parent == 0) {
    const auto process = Process::start([&] { stay_with_a_daemon(alive); });
    stay();
  }
  const bool were_alive = alive.are_alive(2);
  ::kill(parent, SIGKILL);
  ::waitpid(parent, nullptr, 0);
  EXPECT_TRUE(were_alive);
  EXPECT_TRUE(alive.are_gone());
}

// As a port that a worker started: there is one guard, above both.
TEST(Process, TheDaemonsOfAProcessBelowAGuardEndWithIt) {
  Process worker = started([] {
    Alive alive;
    Process port = started([&] { stay_with_a_daemon(alive); });
    const bool were_alive = alive.are_alive(2);
    port.stop(0);
    ::_exit(were_alive && alive.are_gone() ? EXIT_SUCCESS : EXIT_FAILURE);
  });
  EXPECT_TRUE(worker.end(60).is_success());
}

TEST(Process, TheDaemonsOfAProcessBelowAGuardEndWithTheOwnerOfTheGuard) {
  Alive alive;
  const pid_t owner = ::fork();
  if (owner == 0) {
    const auto worker = Process::start([&] {
      const auto port = Process::start([&] { stay_with_a_daemon(alive); });
      stay();
    });
    stay();
  }
  const bool were_alive = alive.are_alive(2);
  ::kill(owner, SIGKILL);
  ::waitpid(owner, nullptr, 0);
  EXPECT_TRUE(were_alive);
  EXPECT_TRUE(alive.are_gone());
}

// Each process is the parent of the next one, so that the death of one makes one orphan.
TEST(Process, ALongLineOfSessionsEndsWithIt) {
  constexpr int length = 150;
  Alive alive;
  Process process = started([&] {
    for (int i = 0; i < length && ::fork() == 0; ++i) ::setsid();
    stay_whatever_comes(alive);
  });
  ASSERT_TRUE(alive.are_alive(length + 1));
  process.stop(0);
  EXPECT_TRUE(alive.are_gone());
}

// A signal to the group reaches what the process started, but not the guard.
TEST(Process, ThatKillsItsOwnGroupLeavesNoDaemon) {
  Alive alive;
  Process process = started([&] {
    if (::fork() == 0) stay_with_a_daemon(alive);
    if (!alive.are_alive(2)) ::_exit(EXIT_FAILURE);
    ::kill(0, SIGKILL);
    stay();
  });
  EXPECT_TRUE(process.ends_within(60));
  EXPECT_TRUE(alive.are_gone());
  EXPECT_EQ(process.end(60).to_string(), "was killed by signal 9 (Killed)");
}

TEST(Process, LeavesNoZombie) {
  started([] {}).end(60);
  started(stay).end(0);
  { const Process process = started(stay); }
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

TEST(Process, IsMovedWithWhatWasDoneToIt) {
  Process one = started(stay);
  Process two = started(stay);
  const pid_t kept = one.pid();
  one.kill();
  two = std::move(one);  // the second is killed and reaped
  EXPECT_EQ(two.pid(), kept);
  EXPECT_TRUE(two.was_killed());
  EXPECT_EQ(one.pid(), -1);  // NOLINT: that is what is tested
  EXPECT_EQ(two.end(60).to_string(), "was killed by signal 9 (Killed)");
}

}  // namespace
}  // namespace attest
