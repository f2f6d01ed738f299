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
  Nanoseconds release{0};     // release_number periods; if triggered: publication of the sample
  Nanoseconds deadline{0};    // one period after the release
  Nanoseconds start{0};       // when the thread woke up for this tick
  Nanoseconds sampled{0};     // time of the plant's state that the unit got; -1: it has got none
  Nanoseconds begins{0};      // when the inputs were taken; the unit's timestamp
  Nanoseconds finish{0};      // when the unit's outputs were sent
  Nanoseconds elapsed{0};     // of the unit's step and the mixer, on the clock
  Nanoseconds cpu{0};         // CPU time of the unit's step and the mixer
  bool waited = false;        // the step gave up the CPU by itself: it slept, or waited for a lock
  std::uint32_t skipped = 0;  // releases skipped between this tick and the next
  Nanoseconds commanded{-1};  // LoopTick::commanded; -1: its outputs were never used
  std::int64_t cost = -1;     // of the unit's step, as the port counts it; -1: it does not count
  Nanoseconds counted{-1};    // `cost` as a time, which the judge sets; -1: it has no duration

  Nanoseconds latency() const { return start - release; }
  Nanoseconds response() const { return finish - release; }
  // Of the sample that the step used, at its finish. Before the first sample: since time 0.
  Nanoseconds age() const { return finish - std::max(sampled, Nanoseconds(0)); }

  // The CPU time of the step, so that preemption does not count. For a step that waits by itself it
  // is the elapsed time, because such waiting is the port's own delay. The two clocks are read one
  // after the other, so `cpu` can be slightly above `elapsed`. A time that the port counts takes
  // the place of both.
  Nanoseconds execution() const {
    if (counted >= Nanoseconds(0)) return counted;
    return waited ? elapsed : std::min(cpu, elapsed);
  }
};

}  // namespace attest
