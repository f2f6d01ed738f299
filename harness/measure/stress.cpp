#include "harness/measure/stress.hpp"

#include <algorithm>

#include <fmt/format.h>

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

// The result if the port's declarations before the run exclude the task; else empty.
std::optional<StressResults> declined(const StressTask& task) {
  StressResult stress;
  stress.result = result_for(task.the_case, task.configuration);
  const auto& step = task.port.fixed_step;
  const LoopRate& rate = task.configuration.rate;
  if (step && (*step != rate.motor_unit || *step != rate.attitude_unit.value_or(rate.motor_unit))) {
    stress.result.verdict = Verdict::unsupported;
    stress.result.reason = fmt::format("the port has a fixed step of {} Hz", step->to_string());
    return StressResults{stress};
  }
  if (!marks_declined(task.port, stress.result)) return std::nullopt;
  return StressResults{stress};
}

using TimeOfTick = Nanoseconds (LiveTick::*)() const;

Histogram histogram_of(const std::vector<LiveTick>& ticks, TimeOfTick time) {
  Histogram histogram;
  for (const LiveTick& tick : ticks) histogram.add((tick.*time)());
  return histogram;
}

// Sets LiveTick::counted, if the port counts costs that have a duration.
void set_counted(const std::optional<CostCounter>& counter, LiveUnitRecord& unit) {
  const auto unit_ns = counter ? counter->unit_ns() : std::nullopt;
  if (!unit_ns) return;
  for (LiveTick& tick : unit.ticks) {
    // The slowest clock and the largest count exceed the range of Nanoseconds.
    const double ns = static_cast<double>(tick.cost) * *unit_ns;
    if (tick.cost >= 0) tick.counted = nanoseconds(ns / 1000);
  }
}

Nanoseconds longest_gap(const std::vector<LiveTick>& ticks) {
  Nanoseconds longest{0};
  for (std::size_t i = 1; i < ticks.size(); ++i) {
    longest = std::max(longest, ticks[i].begins - ticks[i - 1].begins);
  }
  return longest;
}

}  // namespace

void summarise(const LiveFlight& flight, const LiveUnitRecord& unit, const Rate& rate,
               const RealtimeBudget& budget, StressResult& stress) {
  const Histogram execution = histogram_of(unit.ticks, &LiveTick::execution);
  stress.execution = percentiles_of(execution);
  stress.latency = percentiles_of(histogram_of(unit.ticks, &LiveTick::latency));
  stress.response = percentiles_of(histogram_of(unit.ticks, &LiveTick::response));
  stress.age = percentiles_of(histogram_of(unit.ticks, &LiveTick::age));
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
  stress.plant_steps = flight.plant.steps();
  stress.plant_late_steps = flight.plant.late_steps;
  stress.longest_gap = longest_gap(unit.ticks);
  if (!flight.unit.ticks.empty()) stress.wall = flight.unit.ticks.back().begins;
  stress.unit_usage = unit.usage;
  stress.plant_usage = flight.plant.usage;
  stress.privileges = flight.privileges;
  stress.slow = slow_ticks(unit.ticks, execution.percentile(0.5));
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

TimelineLimits limits_of(const RealtimeBudget& budget) {
  TimelineLimits limits{std::nullopt, nanoseconds(budget.p99_latency_us)};
  if (budget.execution_us) limits.execution = nanoseconds(*budget.execution_us);
  return limits;
}

Result<StressResults> judge_live(const StressTask& task, const Percentiles& idle,
                                 LiveFlight flight) {
  set_counted(task.port.cost, flight.unit);
  if (flight.attitude_unit) set_counted(task.port.cost, *flight.attitude_unit);
  StressResults results;
  const auto add = [&]() -> StressResult& {
    results.emplace_back().result = result_for(task.the_case, task.configuration);
    return results.back();
  };
  if (flight.fault) {
    judge(*flight.fault, add().result);
    return results;
  }
  if (task.record_timing) {
    const TimingFile timing{task.the_case.id(), task.the_case.sha256, task.configuration,
                            task.the_case.duration.amount, flight.timing()};
    if (auto written = write_timing(timing, std::move(*task.record_timing)); !written) {
      return tl::unexpected(written.error());
    }
  }
  const bool is_cascade = task.the_case.attitude_loop.has_value();
  const auto judge_one = [&](Module module, const LiveUnitRecord& unit, const Rate& rate) {
    if (is_cascade && !contains(task.port.modules, module)) return;
    StressResult& stress = add();
    summarise(flight, unit, rate, task.the_case.flight->realtime, stress);
    stress.idle = idle;
    if (is_cascade) stress.module = module;
    judge_unit(task, module, flight, results.size() == 1, stress);
  };
  const LoopRate& rate = task.configuration.rate;
  judge_one(task.the_case.module, flight.unit, rate.motor_unit);
  if (const auto& attitude = flight.attitude_unit) {
    judge_one(Module::attitude_unit, *attitude, *rate.attitude_unit);
  }
  return results;
}

Result<StressResults> run_stress(const StressTask& task, const HostOptions& options,
                                 const std::function<bool()>& stop,
                                 const std::function<void(const StressProgress&)>& progress) {
  if (auto unsupported = declined(task)) return *std::move(unsupported);
  auto host = start_host(options, {&task.the_case, task.vehicle_model.get()});
  if (!host) return tl::unexpected(host.error());
  progress({{}, true});
  const Percentiles idle = percentiles_of(
      idle_latency(task.configuration.rate.motor_unit, task.idle_duration, task.live, stop));
  const auto watch = [&](const LiveProgress& live) { progress({live, false}); };
  auto flight = (*host)->fly_live({task.configuration, task.live, checked_ticks}, {stop, watch});
  if (!flight) return tl::unexpected(flight.error());
  return judge_live(task, idle, *std::move(flight));
}

}  // namespace attest
