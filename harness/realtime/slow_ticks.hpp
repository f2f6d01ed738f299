// Finds the steps that took much longer than the others, and their rhythm. A rhythm shows that not
// a busy machine but the port is the cause, for example by housekeeping in every hundredth step.
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

// Steps that are slow by execution time, in which preemption does not count.
struct SlowTicks {
  Nanoseconds threshold{0};      // the larger of 8 x median and median + 20 us
  std::size_t count = 0;         // steps slower than the threshold
  std::vector<SlowTick> worst;   // the slowest eight, by execution time
  std::optional<Rhythm> rhythm;  // in numbers of steps
};

// `median` of the execution times.
SlowTicks slow_ticks(const std::vector<LiveTick>& ticks, Nanoseconds median);

}  // namespace attest
