// The clock that a loop waits on. Simulated time jumps to each deadline (here); real time passes
// (realtime/pacer.hpp).
#pragma once

#include <algorithm>

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

// wait_until() does not wait: it sets the time to the deadline, unless this has passed.
class SimulatedClock final : public Clock {
 public:
  Nanoseconds now() override { return now_; }
  Nanoseconds wait_until(Nanoseconds deadline) override { return now_ = std::max(now_, deadline); }

 private:
  Nanoseconds now_{0};
};

}  // namespace attest
