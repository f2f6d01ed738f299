// The times of one step of a unit on a clock. The terms are those of docs/timing.md, which follow
// Buttazzo, "Hard Real-Time Computing Systems" (3rd ed.), section 2.2, and Liu, "Real-Time
// Systems", section 3.1.
#pragma once

#include <algorithm>
#include <cstdint>

#include "harness/core/time.hpp"

namespace attest {

struct LiveTick {
  std::int64_t release_number = 0;
  Nanoseconds release{0};     // k periods; of a triggered unit: when the sample was published
  Nanoseconds deadline{0};    // one period after the release
  Nanoseconds start{0};       // when the thread began to run for it
  Nanoseconds sampled{0};     // time of the plant's state that it was given; -1: before any
  Nanoseconds begins{0};      // its timestamp
  Nanoseconds finish{0};      // when its commands were written
  Nanoseconds elapsed{0};     // of the unit's step and the mixer, on the clock
  Nanoseconds cpu{0};         // of that, CPU time
  bool waited = false;        // the step gave up the CPU by itself: it slept, or waited for a lock
  std::uint32_t skipped = 0;  // releases after this one that were passed over

  Nanoseconds latency() const { return start - release; }
  Nanoseconds response() const { return finish - release; }

  // The CPU time of the step, so that a preemption does not count. A step that waits by itself
  // counts with all its elapsed time, because its waiting delays the response like computing. The
  // two clocks are read one after the other, so `cpu` can be slightly above `elapsed`.
  Nanoseconds execution() const { return waited ? elapsed : std::min(cpu, elapsed); }
};

}  // namespace attest
