// Steps that took much longer than the others, and whether they come in a rhythm. Without the
// rhythm, a port that does its housekeeping in every hundredth step looks like a busy machine.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "harness/core/time.hpp"
#include "harness/realtime/live_tick.hpp"
#include "harness/realtime/rhythm.hpp"

namespace attest {

struct SlowTick {
  std::size_t tick = 0;
  Nanoseconds execution{0}, elapsed{0};  // as in LiveTick
};

// Slow by execution time: a step that was preempted is not slow.
struct SlowTicks {
  Nanoseconds threshold{0};      // the larger of 8 x median and median + 20 us
  std::size_t count = 0;         // slower than that
  std::vector<SlowTick> worst;   // the slowest eight, by execution time
  std::optional<Rhythm> rhythm;  // in numbers of steps
};

// `median` of the execution times.
SlowTicks slow_ticks(const std::vector<LiveTick>& ticks, Nanoseconds median);

}  // namespace attest
