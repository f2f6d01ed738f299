#include "harness/measure/stress.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "harness/loop/flight.hpp"
#include "harness/loop/timing_file.hpp"
#include "harness/measure/stress_judge.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/judge.hpp"

namespace attest {
namespace {

// Limits the result, because a budget may exceed the range of Nanoseconds.
Nanoseconds nanoseconds(double microseconds) {
  constexpr double longest_us = 1e15;
  return Nanoseconds(static_cast<std::int64_t>(std::min(microseconds, longest_us) * 1000));
}

}  // namespace

void summarise(const LiveFlight& flight, const LiveUnitRecord& unit, const Rate& rate,
               const RealtimeBudget& budget, StressResult& stress) {
  stress.latency = percentiles_of(unit.latency);
  stress.execution = percentiles_of(unit.execution);
  stress.response = percentiles_of(unit.response);
  stress.age = percentiles_of(unit.age);
  stress.plant = percentiles_of(flight.plant.latency);
  stress.ticks = unit.ticks.size();
  stress.deadlines = unit.ticks.size() + unit.skipped;
  stress.misses = deadline_misses(unit.ticks, rate, nanoseconds(budget.p99_latency_us));
  stress.misses.skipped = unit.skipped;  // also counts the releases before the first tick
  for (const LiveTick& tick : unit.ticks) {
    if (tick.waited) ++stress.waiting_steps;
    const bool limited = budget.execution_us.has_value();
    if (limited && tick.execution() > nanoseconds(*budget.execution_us)) ++stress.overruns;
  }
  stress.plant_steps = flight.plant.steps;
  stress.plant_late_steps = flight.plant.late_steps;
  stress.longest_gap = unit.longest_gap;
  stress.wall = flight.wall;
  stress.unit_usage = unit.usage;
  stress.plant_usage = flight.plant.usage;
  stress.privileges = flight.privileges;
  stress.slow = slow_ticks(unit.ticks, unit.execution.percentile(0.5));
}

Percentiles percentiles_of(const Histogram& histogram) {
  const auto percentile = [&](double part) -> std::optional<Nanoseconds> {
    if (!supports_percentile(histogram.count(), part)) return std::nullopt;
    return histogram.percentile(part);
  };
  return {histogram.count(), histogram.min(),  histogram.max(),   percentile(0.5),
          percentile(0.9),   percentile(0.99), percentile(0.999), histogram.buckets()};
}

double StressResult::per_million(std::uint64_t count) const {
  return deadlines == 0 ? 0 : 1e6 * static_cast<double>(count) / static_cast<double>(deadlines);
}

const Rate& StressResult::unit_rate() const {
  return module == Module::attitude_unit ? *result.rate.attitude_unit : result.rate.motor_unit;
}

Result<StressMeasurement> measure_live(const StressTask& task, Port& port,
                                       const std::function<bool()>& stop,
                                       const std::function<void(const StressProgress&)>& progress) {
  StressMeasurement measured;
  const bool is_cascade = task.the_case.attitude_loop.has_value();
  // The judge uses the modules declared before the run, so they must not have changed.
  if (is_cascade && port.modules() != task.port.modules) return measured;
  const auto units = units_for(task.the_case, port);
  if (!units) {
    if (units.error().kind != PortFault::Kind::profile) measured.refusal = units.error();
    return measured;
  }
  progress({{}, true});
  const LoopRate& rate = task.configuration.rate;
  const Histogram idle = idle_latency(rate.motor_unit, task.idle_duration, task.live, stop);
  auto flight =
      fly_live(task.the_case, task.configuration, *task.vehicle_model, units->for_flight(),
               task.live, checked_ticks, stop, [&](const LiveProgress& live) {
                 progress({live, false});
               });
  if (!flight) return tl::unexpected(flight.error());
  const RealtimeBudget& budget = task.the_case.flight->realtime;
  summarise(*flight, flight->unit, rate.motor_unit, budget, measured.stress);
  measured.stress.idle = percentiles_of(idle);
  if (const auto& attitude_unit = flight->attitude_unit) {
    StressResult& stress = measured.attitude_unit.emplace();
    summarise(*flight, *attitude_unit, *rate.attitude_unit, budget, stress);
    stress.idle = measured.stress.idle;
  }
  measured.flight = *std::move(flight);
  return measured;
}

TimelineLimits limits_of(const RealtimeBudget& budget) {
  TimelineLimits limits{std::nullopt, nanoseconds(budget.p99_latency_us)};
  if (budget.execution_us) limits.execution = nanoseconds(*budget.execution_us);
  return limits;
}

Result<StressResults> judge_live(const StressTask& task, StressMeasurement measurement) {
  const auto fresh = [&](StressResult stress) {
    stress.result = result_for(task.the_case, task.configuration);
    return stress;
  };
  StressResults results;
  if (!measurement.flight) {
    results.push_back(fresh(std::move(measurement.stress)));
    const PortFault no_unit = no_unit_of(task.the_case.profile, task.port);
    const auto refusal = measurement.refusal.value_or(no_unit);
    judge(*held_to(task.port, task.the_case.profile, refusal), results.front().result);
    return results;
  }
  LiveFlight& flight = *measurement.flight;
  if (task.record_timing) {
    const TimingFile timing{task.the_case.id(), task.the_case.sha256, task.configuration,
                            task.the_case.duration.amount, flight.timing()};
    if (auto written = write_timing(timing, std::move(*task.record_timing)); !written) {
      return tl::unexpected(written.error());
    }
  }
  const auto add = [&](StressResult& stress, Module module) {
    const bool is_cascade = task.the_case.attitude_loop.has_value();
    if (is_cascade && !contains(task.port.modules, module)) return;
    results.push_back(fresh(std::move(stress)));
    results.back().module = is_cascade ? std::optional(module) : std::nullopt;
    judge_unit(task, module, flight, results.size() == 1, results.back());
  };
  add(measurement.stress, task.the_case.module);
  if (measurement.attitude_unit) add(*measurement.attitude_unit, Module::attitude_unit);
  return results;
}

}  // namespace attest
