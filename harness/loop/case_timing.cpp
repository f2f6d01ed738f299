#include "harness/loop/case_timing.hpp"

#include <algorithm>
#include <cmath>

#include "harness/casefile/stimulus.hpp"
#include "harness/schedule/ticks.hpp"

namespace attest {
namespace {

// The estimator's last sample by `time`, on a clock that drifts from the loop's.
Nanoseconds drifted(Nanoseconds time, const Rate& rate, double drift) {
  const double period_ns = rate.period_s() * 1e9 / (1 + drift);
  const double samples = std::floor(static_cast<double>(time.count()) / period_ns);
  return std::min(time, Nanoseconds(static_cast<std::int64_t>(samples * period_ns)));
}

// The estimator samples on its clock, and the unit runs when the sample arrives.
LoopTiming timing_on_estimate(const Case& the_case, const Rate& rate) {
  const Flight& flight = *the_case.flight;
  const Nanoseconds before = flight.estimator.delay.on(rate);
  const Nanoseconds after = flight.actuator_delay.on(rate);
  const Nanoseconds end = timeline_of(the_case, rate).duration;
  LoopTiming timing;
  for (const Nanoseconds sampled : unit_ticks(the_case, rate, flight.estimator.drift.value_or(0))) {
    const Nanoseconds begins = sampled + before;
    if (begins < end) timing.push_back({sampled, begins, begins + after});
  }
  return timing;
}

}  // namespace

LoopTiming case_timing(const Case& the_case, const Rate& rate) {
  if (the_case.unit.on_estimate) return timing_on_estimate(the_case, rate);
  const Flight& flight = *the_case.flight;
  const Nanoseconds before = flight.estimator.delay.on(rate);
  const Nanoseconds after = flight.actuator_delay.on(rate);
  LoopTiming timing;
  for (const Nanoseconds begins : unit_ticks(the_case, rate)) {
    Nanoseconds sampled = begins - before;
    if (flight.estimator.drift) sampled = drifted(sampled, rate, *flight.estimator.drift);
    timing.push_back({sampled, begins, begins + after});
  }
  return timing;
}

std::vector<Nanoseconds> task_times(const TaskTiming& timing, const Timeline& timeline) {
  TickSchedule schedule;
  schedule.rate = timing.rate;
  schedule.phase = timing.phase.on(timeline.rate);
  schedule.jitter = timing.jitter;
  schedule.seed = timing.seed;
  schedule.drops = timing.drop_ticks;
  return ticks(schedule, timing.rate.ticks_in(timeline.duration));
}

}  // namespace attest
