// Shows when in a flight steps were late or long. The flight is divided into parts, and each part
// has the figures of its ticks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "harness/core/time.hpp"
#include "harness/realtime/live_tick.hpp"

namespace attest {

// The ticks that were released within a part of the flight.
struct TimelinePart {
  Nanoseconds begin{0};
  std::uint64_t ticks = 0;
  Nanoseconds latency{0}, execution{0}, response{0};  // the longest
  std::uint64_t late = 0, skipped = 0;                // as in DeadlineMisses
  std::uint64_t overruns = 0;                         // execution above its limit
  std::uint64_t late_starts = 0;                      // latency above its limit
};

struct TimelineTick {
  std::size_t number = 0;
  LiveTick tick;
};

struct FlightTimeline {
  std::vector<TimelinePart> parts;  // of equal duration; parts without a tick are left out
  std::vector<TimelineTick> worst;  // the eight longest responses, longest first
};

struct TimelineLimits {
  std::optional<Nanoseconds> execution;
  Nanoseconds latency = Nanoseconds::max();
};

// At most 400 parts from the first release to the last.
FlightTimeline flight_timeline(const std::vector<LiveTick>& ticks, const TimelineLimits& limits);

}  // namespace attest
