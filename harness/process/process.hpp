// A child process and its owner, the process that starts it. The owner can always end the child
// process. The child process ends at the latest with the owner.
#pragma once

#include <functional>

#include <sys/types.h>

#include "harness/core/result.hpp"
#include "harness/process/ending.hpp"

namespace attest {

// The process leads a process group of its own. Its descendants end with it, also those in other
// groups or sessions (daemons). No member function waits longer than its argument and a few
// seconds.
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
  // Forks. `work` runs in the child, which then exits with status 0. The child starts with default
  // signal handlers and an empty signal mask, and leaves no core file. `work` must not throw.
  static Result<Process> start(const std::function<void()>& work);

  // Takes over a child process that start() did not make. `fork` makes it: it lets another process
  // call fork_sibling(), and returns the number of the new process, or -1 with errno. The child
  // process has no guard. Until `fork` returns, signals are blocked, and other threads cannot start
  // processes.
  static Result<Process> adopt(const std::function<pid_t()>& fork);

  Process() = default;  // none, same as after end()
  Process(Process&& other) noexcept;
  Process& operator=(Process&& other) noexcept;
  ~Process();  // kills

  pid_t pid() const { return pid_; }  // of the guard, if there is one; -1 after end()

  // True if it has ended by itself, or does so in that time. end() then still returns how.
  bool ends_within(double seconds);

  void terminate();  // sends SIGTERM to the group
  void kill();       // sends SIGKILL to the process and its descendants
  bool was_killed() const { return was_killed_; }

  // Waits up to `patience_s` for it to end by itself, then kills it with its descendants.
  Ending end(double patience_s);

  // Sends SIGTERM, and kills it after the grace period.
  Ending stop(double grace_s);

 private:
  explicit Process(pid_t pid) : pid_(pid) {}

  pid_t pid_ = -1;
  bool has_guard_ = false;
  bool was_killed_ = false;
};

// Forks, as Process::start() does, but for another owner, the parent of this process, which adopts
// the child process. This process forks a process in between, which forks the child process and
// ends. Then the owner becomes the parent, because the owner is a subreaper. Returns the number of
// the child process; -1: errno has the reason. REQUIRES: this process is below a guard, and its
// other threads hold no lock.
pid_t fork_sibling(const std::function<void()>& work);

// Whether this process, or one above it, has a guard: true in a worker and in all below it.
bool is_below_guard();

}  // namespace attest
