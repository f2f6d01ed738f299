// The times of a closed loop, tick by tick: as a case schedules them, or as they really were.
#pragma once

#include <optional>
#include <vector>

#include "harness/core/time.hpp"

namespace attest {

// Since the begin of the case. REQUIRES: sampled <= begins <= commanded.
struct LoopTick {
  Nanoseconds sampled{0};  // of this time is the state of the plant that the unit is told
  Nanoseconds begins{0};   // the unit runs, and this is its timestamp
  // The motors follow what it says from then on; empty: they never do, as the next tick's command
  // is there first.
  std::optional<Nanoseconds> commanded;

  friend bool operator==(const LoopTick&, const LoopTick&) = default;
};

// REQUIRES: none of the three decreases from tick to tick, and `begins` increases.
using LoopTiming = std::vector<LoopTick>;

}  // namespace attest
