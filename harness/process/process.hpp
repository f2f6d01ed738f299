// A child process that its owner can always end. It ends at the latest with this process.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <sys/types.h>

#include "harness/core/result.hpp"

namespace attest {

// How a process ended.
struct Ending {
  bool was_killed = false;         // by us
  std::optional<int> wait_status;  // of waitpid(); empty: not even SIGKILL ended it in time

  bool is_success() const;  // it exited with status 0

  // As a verb: "was killed by signal 11 (Segmentation fault)", "exited with status 0".
  std::string to_string() const;
};

// The process leads a process group of its own. Its descendants in that group end with it. Those in
// other groups or sessions become children of this process when their parents have ended; the next
// end() of any Process kills them. No member function waits longer than its argument and a few
// seconds.
//
// When this process dies, even by SIGKILL, the process ends too. Its descendants then end only if
// the group has a second process, the guard. Code of others needs the guard. Code of attest starts
// only Processes, which end with their parent.
//
// One thread at a time. The thread that calls start() must live as long as the Process, because
// Linux treats the end of that thread as the death of the parent.
class Process {
 public:
  // Forks. `work` runs in the child, which then exits with status 0. The child starts with default
  // signal handlers and an empty signal mask, and leaves no core file. `work` must not throw.
  static Result<Process> start(const std::function<void()>& work, bool with_guard = true);

  Process() = default;  // none, same as after end()
  Process(Process&& other) noexcept;
  Process& operator=(Process&& other) noexcept;
  ~Process();  // kills

  pid_t pid() const { return pid_; }  // -1 after end()

  // True if it has ended by itself, or does so in that time. end() then still returns how.
  bool ends_within(double seconds);

  void terminate();  // sends SIGTERM to the group
  void kill();       // sends SIGKILL to the group
  bool was_killed() const { return was_killed_; }

  // Waits up to `patience_s` for it to end by itself, then kills it with its group.
  Ending end(double patience_s);

  // Sends SIGTERM, and kills it after the grace period.
  Ending stop(double grace_s);

 private:
  Process(pid_t pid, pid_t guard) : pid_(pid), guard_(guard) {}

  pid_t pid_ = -1;
  pid_t guard_ = -1;
  bool was_killed_ = false;
};

}  // namespace attest
