// What a loop waits on: time that jumps where it is wanted (here), or that passes
// (realtime/pacer.hpp).
#pragma once

#include <algorithm>

#include "harness/core/time.hpp"

namespace attest {

// Of one thread. Times count from the same origin for all clocks of a run, and never decrease.
class Clock {
 public:
  virtual ~Clock() = default;

  virtual Nanoseconds now() = 0;

  // Returns at `deadline`, or later, or at once when that has passed: now().
  virtual Nanoseconds wait_until(Nanoseconds deadline) = 0;
};

// Is never late.
class SimulatedClock final : public Clock {
 public:
  Nanoseconds now() override { return now_; }
  Nanoseconds wait_until(Nanoseconds deadline) override { return now_ = std::max(now_, deadline); }

 private:
  Nanoseconds now_{0};
};

}  // namespace attest
