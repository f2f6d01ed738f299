// Signals while a process forks.
#pragma once

#include <signal.h>

namespace attest {

// Blocks all signals of this thread while the object exists. Between fork() and reset_signals(), a
// handler of the parent must not run in the child.
class SignalsBlocked {
 public:
  SignalsBlocked();
  ~SignalsBlocked();
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_{};
};

// Called in the child: sets the default handlers and an empty mask. The handlers of error signals,
// such as SIGSEGV, stay: the sanitizers report errors with them.
void reset_signals();

}  // namespace attest
