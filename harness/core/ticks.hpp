// The ticks of the unit's task and the releases of the topics that it reads, as times since the
// start of the case.
//
// Order at one instant: a topic released at the time of a tick is seen by that tick.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "harness/core/rate.hpp"
#include "harness/core/time.hpp"

namespace attest {

// Other work holds the processor: from each positive multiple of `every`, for `length`, no tick
// runs. The first delayed tick runs at the end of the stall. If `catches_up`, the other delayed
// ticks follow it, a tenth of a period apart; otherwise they are left out.
struct Stall {
  Nanoseconds every{0};  // 0: never
  Nanoseconds length{0};
  bool catches_up = false;
};

// A periodic task: tick k is at phase + k / rate, delayed by seeded jitter and by stalls. Some
// ticks may be left out.
struct TickSchedule {
  Rate rate = Rate::hz(250);
  Nanoseconds phase{0};
  // Fraction of a period, in [0, 1). Without `heavy_tail`, a tick is late by a uniform part of it.
  // With `heavy_tail`, it is late by jitter (1 / sqrt(u) - 1) periods, u uniform in (0, 1]; this
  // has no finite variance.
  double jitter = 0;
  std::uint64_t seed = 1;           // of the jitter
  std::vector<std::int64_t> drops;  // values of k that are left out
  bool heavy_tail = false;
  std::int64_t drop_every = 0;  // of each group of so many ticks, the last is left out; 0: off
  Stall stall;                  // in times without `phase`, which is added later
};

// The ticks with k in [0, periods). A tick is left out if it would come less than 1 us after the
// previous tick, or before it; with `stall.catches_up` it runs later instead. The same arguments
// give the same ticks on every machine.
std::vector<Nanoseconds> ticks(const TickSchedule& schedule, std::int64_t periods);

// The times at which the samples of a topic are published: periodic (`rate`), or given (`times`).
// If both are empty, no sample is published. With `rate`, release i (from 0) is at
//
//     phase + rate.tick(first + i * every)
//
// If `rate` and `phase` are the unit's, each release is at the same nanosecond as a tick without
// jitter.
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
