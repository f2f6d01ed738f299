// A process that starts the children of its owner.
#pragma once

#include <functional>
#include <string>

#include <sys/types.h>

#include "harness/core/result.hpp"
#include "harness/process/child.hpp"

namespace attest {

// The children are copies of the launcher's memory, and the launcher is a copy of its owner's
// memory at start(). So a child cannot read what the owner has read since then. The parent of a
// child is the owner. A child has the limits, the scheduling and the CPUs of the launcher.
//
// The thread that calls start() must live as long as the launcher. One thread at a time. REQUIRES:
// the owner is below a guard (Process).
class Launcher {
 public:
  // Handles one request in a child.
  using Work = std::function<void(const std::string& request, MessageSocket& owner)>;

  // Forks the launcher. A launcher that does not answer within the time limit is killed. It forks
  // in milliseconds, and takes seconds only on a machine that swaps.
  static Result<Launcher> start(Child::Runs runs, const Work& work, double time_limit_s = 60);

  // The launcher forks a child, and then the owner itself sends the request to that child. So the
  // child's work, which may kill or stop the launcher, begins only after the owner has the child.
  // Errors: no child can be started, or the launcher has died.
  Result<Child> launch(const std::string& request);
  bool is_alive() const { return is_alive_; }  // as far as the last launch() has seen

 private:
  Launcher(Child process, double time_limit_s)
      : process_(std::move(process)), time_limit_s_(time_limit_s) {}

  // Returns the number of the child process, or -1 with errno if there is none.
  pid_t fork_there(const ChildFiles& files);
  std::string why_it_died();

  Child process_;
  double time_limit_s_;
  bool is_alive_ = true, is_late_ = false;
};

}  // namespace attest
