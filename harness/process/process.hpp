// A child process and its owner, the process that starts it. The owner can always end the child
// process. The child process ends at the latest with the owner.
#pragma once

#include <functional>

#include <sys/types.h>

#include "harness/core/result.hpp"
#include "harness/process/ending.hpp"

namespace attest {

// The child process leads a process group of its own. Its descendants end with it, also those in
// other groups or sessions (daemons). No member function waits more than about 15 s longer than its
// argument.
//
// When the owner dies, even by SIGKILL, the child process and its descendants end too. That is the
// work of a guard, a process of attest between the owner and the child process. The guard becomes
// the parent of all descendants whose parents have ended. A process below a guard starts others
// without a guard of their own.
//
// One thread at a time. The thread that calls start() must live as long as the Process, because
// Linux treats the end of that thread as the death of the parent.
class Process {
 public:
  // Forks. `work` runs in the child, which then exits with status 0. The child starts with an empty
  // signal mask and default signal handlers (reset_signals()), and leaves no core file. `work` must
  // not throw. `when_stopped`: whether the guard continues a child that a signal has stopped, such
  // as a worker of attest, which its port may stop; without a guard it stays stopped. `at_end`: the
  // guard calls it when the child process and its descendants have ended, also if the owner has
  // died. REQUIRES, for `at_end`: this process is not below a guard.
  enum class WhenStopped { stays, continues };
  static Result<Process> start(
      const std::function<void()>& work, WhenStopped when_stopped = WhenStopped::stays,
      const std::function<void()>& at_end = [] {});

  // Takes over a child process that start() did not make. `fork` lets another process call
  // fork_sibling(), and returns the id of the new process, or -1 with errno. The new process has no
  // guard of its own. Until `fork` returns, signals are blocked, and other threads cannot start
  // processes. Calls `fork` again for up to 10 s while errno is EAGAIN or ENOMEM.
  static Result<Process> adopt(const std::function<pid_t()>& fork);

  Process() = default;  // no process, same as after end()
  Process(Process&& other) noexcept;
  Process& operator=(Process&& other) noexcept;
  ~Process();  // kills

  pid_t pid() const { return pid_; }  // of the guard, if there is one; -1 after end()

  // Waits up to `seconds`. True: the process has ended, or there is none. A later end() still
  // returns how it ended.
  bool ends_within(double seconds);

  // Continues the guard if a signal has stopped it. A process without a guard stays stopped.
  void wake();

  void terminate();  // sends SIGTERM to the group
  void kill();       // kills the process; its descendants end at the latest in end()
  bool was_killed() const { return was_killed_; }

  // Waits up to `patience_s` for the process to end, then kills it. Kills its descendants in both
  // cases.
  Ending end(double patience_s);

  // Sends SIGTERM, then does the same as end(grace_s).
  Ending stop(double grace_s);

 private:
  explicit Process(pid_t pid) : pid_(pid) {}

  pid_t pid_ = -1;
  bool has_guard_ = false;
  bool was_killed_ = false;
};

// Forks a child process for another owner: the parent of this process, which takes it over with
// Process::adopt(). This process forks a process in between, which forks the child process and
// ends. The owner is a subreaper, so it then becomes the parent of the child process. Returns the
// id of the child process; -1: errno has the reason. REQUIRES: this process is below a guard, and
// its other threads hold no lock.
pid_t fork_sibling(const std::function<void()>& work);

// Whether this process, or one above it, has a guard: true in a worker and in all below it.
bool is_below_guard();

}  // namespace attest
