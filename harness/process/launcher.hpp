// A process that forks children for its owner, the process that started it. The children run code
// of others.
#pragma once

#include <functional>
#include <string>

#include <sys/types.h>

#include "harness/core/result.hpp"
#include "harness/process/child.hpp"

namespace attest {

// The children are copies of the launcher's memory, and the launcher is a copy of its owner's
// memory at start(). So a child cannot read what the owner has read since then. The parent of a
// child is the owner. A child inherits the resource limits, the scheduling and the CPUs of the
// launcher.
//
// The thread that calls start() must live as long as the launcher. One thread at a time. REQUIRES:
// the owner is below a guard (process.hpp).
class Launcher {
 public:
  // Handles one request in a child.
  using Work = std::function<void(const std::string& request, MessageSocket& owner)>;

  // Forks the launcher. launch() kills a launcher that needs more than `time_limit_s` for an
  // answer. An answer takes milliseconds, or seconds on a machine that swaps.
  static Result<Launcher> start(const BarrierOptions& barrier, const Work& work,
                                double time_limit_s = 60);

  // The launcher forks a child, and then the owner itself sends the request to that child. So the
  // child's work, which may kill or stop the launcher, begins only after the owner has taken over
  // the child. Errors: no child can be started; the launcher has died or is late.
  Result<Child> launch(const std::string& request);
  bool is_alive() const { return is_alive_; }  // as far as the last launch() has seen

 private:
  Launcher(Child process, double time_limit_s)
      : process_(std::move(process)), time_limit_s_(time_limit_s) {}

  // Asks the launcher to fork a child. Returns the process id of the child. -1: errno has the
  // reason, or the launcher has died or is late (is_alive_).
  pid_t fork_there(const ChildFiles& files);
  std::string why_it_died();

  Child process_;
  double time_limit_s_;
  bool is_alive_ = true, is_late_ = false;
};

}  // namespace attest
