#include "harness/loop/case_timing.hpp"

#include <algorithm>
#include <cmath>

#include "harness/casefile/stimulus.hpp"
#include "harness/core/ticks.hpp"

namespace attest {
namespace {

// The estimator's last sample at or before `time`, on a clock that drifts from the loop's.
Nanoseconds drifted(Nanoseconds time, const Rate& rate, double drift) {
  const double period_ns = rate.period_s() * 1e9 / (1 + drift);
  const double samples = std::floor(static_cast<double>(time.count()) / period_ns);
  return std::min(time, Nanoseconds(static_cast<std::int64_t>(samples * period_ns)));
}

Nanoseconds until_result(const Case& the_case, const Rate& rate) {
  const bool is_attitude = the_case.module == Module::attitude_unit;
  return (is_attitude ? the_case.attitude_loop->delay : the_case.flight->actuator_delay).on(rate);
}

// The rate unit reads the gyro itself, so the estimator's delay and drift do not apply.
Estimator estimator_of(const Case& the_case) {
  return the_case.module == Module::rate_unit ? Estimator{} : the_case.flight->estimator;
}

// The estimator samples on its own clock, and each arriving sample starts a tick of the unit.
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
  const Estimator estimator = estimator_of(the_case);
  const Nanoseconds before = estimator.delay.on(rate);
  const Nanoseconds after = until_result(the_case, rate);
  LoopTiming timing;
  for (const Nanoseconds begins : unit_ticks(the_case, rate)) {
    Nanoseconds sampled = begins - before;
    if (estimator.drift) sampled = drifted(sampled, rate, *estimator.drift);
    timing.push_back({sampled, begins, begins + after});
  }
  return timing;
}

FlightTiming flight_timing(const Case& the_case, const LoopRate& rate) {
  FlightTiming timing = case_timing(the_case.of_module(the_case.module), rate.motor_unit);
  if (rate.attitude_unit) {
    timing.attitude_unit =
        case_timing(the_case.of_module(Module::attitude_unit), *rate.attitude_unit);
  }
  return timing;
}

TaskTiming land_detection() { return task_at(Rate::hz(50)); }

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
