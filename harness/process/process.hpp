// A child process that ends when its owner says so, and at the latest with this process.
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

// The process leads a process group of its own, and everything that it starts in that group ends
// with it. What it starts in a group or session of its own becomes a child of this process when
// its parent has ended, and is killed by the next end() of any Process. No member function waits
// longer than its argument and a few seconds.
//
// When this process dies, even by SIGKILL, the process ends too. What it started ends then if there
// is a second process in the group, the guard: code of others needs one. Code of ours starts
// Processes only, which see to that themselves.
//
// One thread at a time. The thread that calls start() must live as long as the Process: Linux takes
// the end of that thread for the death of the parent.
class Process {
 public:
  // Forks. `work` runs in the child, which then exits with status 0. The child starts with default
  // signal handlers and an empty signal mask, and leaves no core file. `work` must not throw.
  static Result<Process> start(const std::function<void()>& work, bool with_guard = true);

  Process(Process&& other) noexcept;
  Process& operator=(Process&& other) noexcept;
  ~Process();  // kills

  pid_t pid() const { return pid_; }  // -1 after end()

  // Whether it has ended by itself, or does in that time. end() still says how.
  bool ends_within(double seconds);

  void terminate();  // sends SIGTERM to the group
  void kill();       // sends SIGKILL to the group
  bool was_killed() const { return was_killed_; }

  // Waits so long for it to end by itself, then kills it with its group.
  Ending end(double patience_s);

  // Asks it to end cleanly, and kills it after the grace period.
  Ending stop(double grace_s);

 private:
  Process(pid_t pid, pid_t guard) : pid_(pid), guard_(guard) {}

  pid_t pid_ = -1;
  pid_t guard_ = -1;
  bool was_killed_ = false;
};

}  // namespace attest
