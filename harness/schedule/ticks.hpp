// The ticks of the unit's task and the releases of the topics that it reads, as times since the
// start of the case.
//
// Order at one instant: a topic released at the time of a tick is seen by that tick.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "harness/core/time.hpp"
#include "harness/schedule/rate.hpp"

namespace attest {

// Other work holds the processor: from each positive multiple of `every`, for `length`, no tick
// runs. The first delayed tick runs at the end of the stall. If the task catches up, the others
// follow it, a tenth of a period apart; else they are left out.
struct Stall {
  Nanoseconds every{0};  // 0: never
  Nanoseconds length{0};
  bool catches_up = false;
};

// A periodic task: release k at phase + k / rate, delayed by seeded jitter. Some may be left out.
struct TickSchedule {
  Rate rate = Rate::hz(250);
  Nanoseconds phase{0};
  // Uniform: late by up to this fraction of a period, in [0, 1). With a heavy tail: late by
  // jitter (1 / sqrt(u) - 1) periods, u uniform in (0, 1]; this has no finite variance.
  double jitter = 0;
  std::uint64_t seed = 1;           // of the jitter
  std::vector<std::int64_t> drops;  // values of k that are left out
  bool heavy_tail = false;
  std::int64_t drop_every = 0;  // the last of each group of this many is left out; 0: none
  Stall stall;                  // its times do not include the phase
};

// The ticks with k in [0, periods). A tick is left out if it would come less than 1 us after the
// previous tick, or earlier than that tick; with `stall.catches_up` it runs later. The same
// arguments give the same ticks on every machine.
std::vector<Nanoseconds> ticks(const TickSchedule& schedule, std::int64_t periods);

// The times at which the samples of a topic are published: periodic (`rate`), or given (`times`).
// If both are empty, no sample is published.
// Release i is at phase + rate.tick(first + i * every). So releases counted in the unit's ticks are
// at the same nanosecond as those ticks.
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
