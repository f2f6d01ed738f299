// When things happen: the ticks of the unit's task and the releases of the topics it reads, as
// times since the case began.
//
// Order at one instant: a topic released at the time of a tick is seen by that tick.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "harness/core/time.hpp"
#include "harness/schedule/rate.hpp"

namespace attest {

// Something else holds the processor: from each positive multiple of `every`, for `length`, no tick
// runs. The first tick that was held up runs at the end of it; the others with it, a tenth of a
// period apart, if the task catches up, and else not at all.
struct Stall {
  Nanoseconds every{0};  // 0: never
  Nanoseconds length{0};
  bool catches_up = false;
};

// A periodic task: release k at phase + k / rate, made late by seeded jitter, some left out.
struct TickSchedule {
  Rate rate = Rate::hz(250);
  Nanoseconds phase{0};
  // Late by up to this fraction of a period, uniform; in [0, 1). With a heavy tail: by
  // jitter (1 / sqrt(u) - 1) periods, u uniform in (0, 1], which has no finite variance.
  double jitter = 0;
  std::uint64_t seed = 1;           // of the jitter
  std::vector<std::int64_t> drops;  // values of k that do not happen
  bool heavy_tail = false;
  std::int64_t drop_every = 0;  // the last of each so many does not happen; 0: all do
  Stall stall;                  // of times without the phase
};

// The ticks with k in [0, periods), increasing by a microsecond at least. One that another so late
// has passed over does not happen. The same arguments give the same ticks on every machine.
std::vector<Nanoseconds> ticks(const TickSchedule& schedule, std::int64_t periods);

// When the samples of a topic are published: periodically, at given times, or both empty: never.
// Release i is at phase + rate.tick(first + i * every), so that releases counted in the unit's
// ticks are those very ticks, to the nanosecond.
struct ReleaseSchedule {
  std::optional<Rate> rate;
  Nanoseconds phase{0};
  std::int64_t first = 0;
  std::int64_t every = 1;          // positive
  std::vector<Nanoseconds> times;  // increasing; used when there is no rate

  // The latest release at or before `time`; empty when there was none.
  std::optional<Nanoseconds> latest(Nanoseconds time) const;
};

}  // namespace attest
