// The times of a closed loop, tick by tick: as scheduled by a case, or as recorded in real time.
#pragma once

#include <optional>
#include <vector>

#include "harness/core/time.hpp"

namespace attest {

// Since the start of the case. REQUIRES: sampled <= begins <= commanded.
struct LoopTick {
  Nanoseconds sampled{0};  // time of the plant's state that the unit receives
  Nanoseconds begins{0};   // the unit's step begins; its timestamp
  // From this time on the motors follow the unit's outputs. Empty: they never do, because the
  // command of the next tick arrives first.
  std::optional<Nanoseconds> commanded;

  friend bool operator==(const LoopTick&, const LoopTick&) = default;
};

// REQUIRES: from tick to tick, `begins` increases, and the other two do not decrease.
using LoopTiming = std::vector<LoopTick>;

}  // namespace attest
