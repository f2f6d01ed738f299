// The clock that a real-time loop waits on: that of the machine (pacer.hpp), or a scripted
// one in tests.
#pragma once

#include "harness/core/time.hpp"

namespace attest {

// Used by one thread. Times never decrease, and count from the same origin for all clocks of a run.
class Clock {
 public:
  virtual ~Clock() = default;

  virtual Nanoseconds now() = 0;

  // Waits until `deadline`, or returns at once if it has passed. Returns now(), which may be later
  // than `deadline`.
  virtual Nanoseconds wait_until(Nanoseconds deadline) = 0;
};

}  // namespace attest
