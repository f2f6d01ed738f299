// The times of a closed loop, tick by tick: as scheduled by a case, or as recorded in real time.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "harness/core/time.hpp"

namespace attest {

// A tick of a unit; times since the start of the case. REQUIRES: sampled <= begins <= commanded.
struct LoopTick {
  Nanoseconds sampled{0};  // time of the plant's state that the unit receives
  Nanoseconds begins{0};   // the unit's step begins; its timestamp
  // From this time on the unit's outputs are used: those of the attitude unit by the rate unit,
  // those of other units by the motors. Empty if they are never used, because the outputs of a
  // later tick replaced them before.
  std::optional<Nanoseconds> commanded;

  friend bool operator==(const LoopTick&, const LoopTick&) = default;
};

// REQUIRES: from tick to tick, `begins` increases, and `sampled` and `commanded` do not decrease.
using LoopTiming = std::vector<LoopTick>;

struct FlightTiming {
  FlightTiming() = default;
  FlightTiming(LoopTiming of_unit)  // NOLINT(google-explicit-constructor)
      : unit(std::move(of_unit)) {}

  LoopTiming unit;           // of the unit that commands the motors
  LoopTiming attitude_unit;  // empty without a cascade

  friend bool operator==(const FlightTiming&, const FlightTiming&) = default;
};

}  // namespace attest
