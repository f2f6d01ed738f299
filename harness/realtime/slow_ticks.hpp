// Steps that took much longer than the others, and whether they come regularly: a port that does
// something now and then looks like a machine that does, until one sees the distance between them.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "harness/core/time.hpp"
#include "harness/realtime/live_unit.hpp"

namespace attest {

struct SlowTick {
  std::size_t tick = 0;
  Nanoseconds execution{0}, cpu{0};  // as of LiveTick
};

struct SlowTicks {
  Nanoseconds threshold{0};          // eight times the median, and 20 us more than it
  std::size_t count = 0;             // slower than that
  std::vector<SlowTick> worst;       // the slowest eight, by time
  std::optional<std::size_t> every;  // three or more are this many ticks apart, with hardly a gap
  std::size_t first_regular = 0;     // the first of those
};

SlowTicks slow_ticks(const std::vector<LiveTick>& ticks, Nanoseconds median);

}  // namespace attest
