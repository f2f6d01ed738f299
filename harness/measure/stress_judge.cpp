#include "harness/measure/stress_judge.hpp"

#include <utility>

#include <fmt/format.h>

#include "harness/golden/reference.hpp"
#include "harness/verify/judge.hpp"
#include "harness/verify/reference_comparison.hpp"

namespace attest {
namespace {

// If a larger share of the plant's steps is late, the flight was not in real time: verdict `skip`.
constexpr double plant_late_share = 0.01;
// A budget of the 99th percentile allows this share of late starts. They are counted, so that no
// percentile is needed.
constexpr double late_starts_share = 0.01;

int gravity(Verdict verdict) { return fails_a_run(verdict) ? 2 : verdict == Verdict::pass ? 0 : 1; }

// Keeps the more severe verdict, and puts its reason first.
void add(VectorResult& result, Verdict verdict, std::string reason) {
  const bool is_graver = gravity(verdict) > gravity(result.verdict);
  if (is_graver) result.verdict = verdict;
  if (result.reason.empty()) {
    result.reason = std::move(reason);
  } else if (is_graver) {
    result.reason = std::move(reason) + "; " + result.reason;
  } else {
    result.reason += "; " + reason;
  }
}

double share_of(std::uint64_t count, std::uint64_t all) {
  return all == 0 ? 0 : static_cast<double>(count) / static_cast<double>(all);
}

void judge_port(const RealtimeBudget& budget, StressResult& stress) {
  const DeadlineMisses& misses = stress.misses;
  const double allowed = budget.misses_per_million;
  const auto fail = [&](std::string reason) {
    add(stress.result, Verdict::fail, std::move(reason));
  };
  if (const double overruns = stress.per_million(stress.overruns); overruns > allowed) {
    fail(
        fmt::format("{} overruns of the execution time of {:g} us: {:.0f} per million, budget {:g}",
                    stress.overruns, budget.execution_us.value_or(0), overruns, allowed));
  }
  if (const double missed = stress.per_million(misses.by_port); missed > allowed) {
    fail(
        fmt::format("{} of {} deadline misses are caused by the port's execution time: {:.0f} per "
                    "million, budget {:g}",
                    misses.by_port, misses.total(), missed, allowed));
  }
  if (share_of(misses.late_starts_by_port, stress.ticks) > late_starts_share) {
    fail(
        fmt::format("{} of {} steps start more than {:g} us after their release because the step "
                    "before runs too long; budget 1%",
                    misses.late_starts_by_port, stress.ticks, budget.p99_latency_us));
  }
}

void judge_machine(const RealtimeBudget& budget, StressResult& stress) {
  const DeadlineMisses& misses = stress.misses;
  const double allowed = budget.misses_per_million;
  if (const double missed = stress.per_million(misses.total()); missed > allowed) {
    add_skip(stress.result,
             fmt::format("too many deadlines missed on this machine: {} of {}, {:.0f} "
                         "per million, budget {:g}; {} of them by the port's execution time",
                         misses.total(), stress.deadlines, missed, allowed, misses.by_port));
  }
  if (share_of(misses.late_starts, stress.ticks) > late_starts_share) {
    add_skip(
        stress.result,
        fmt::format(
            "too many late starts on this machine: {} of {} steps start more than {:g} us after "
            "their release, budget 1%; {} of them because the step before runs too long; at most "
            "{:.3g} us on the idle machine",
            misses.late_starts, stress.ticks, budget.p99_latency_us, misses.late_starts_by_port,
            in_microseconds(stress.idle.max)));
  }
}

std::string in_ms(Nanoseconds time) { return fmt::format("{:.3g} ms", 1000 * in_seconds(time)); }

}  // namespace

void add_skip(VectorResult& result, const std::string& reason) {
  add(result, Verdict::skip, reason);
}

void judge_outputs(const Case& the_case, Module module, LiveUnitRecord& unit,
                   std::optional<int> fraction_bits, VectorResult& result) {
  Trace got;
  got.present = channels_of(module);
  got.samples = std::move(unit.samples);
  got.parameters = std::move(unit.changes);
  if (got.samples.empty()) return add_skip(result, "outputs not judged: no step finished");
  const std::size_t compared = got.samples.size();
  const auto answers = compare_with_reference(
      got, the_case.profile, tolerances_of(the_case, Level::numeric, fraction_bits, compared),
      fraction_bits);
  if (!answers) return add_skip(result, "outputs not judged: " + answers.error().to_string());
  judge(answers->comparison, result);
  if (const auto& undecided = answers->undecided) {
    add_skip(result,
             fmt::format("outputs not judged from tick {} on, which comes too near to a "
                         "decision ({}): tick {} deviates",
                         undecided->tick, name_of(undecided->decision), undecided->deviating_tick));
  }
  if (result.verdict == Verdict::pass && compared < unit.ticks.size()) {
    add_skip(result, fmt::format("outputs judged for the first {} of {} ticks only: choose a "
                                 "shorter --duration",
                                 compared, unit.ticks.size()));
  }
  if (fails_a_run(result.verdict) && result.reason.empty()) {
    result.reason = "outputs differ from the reference's";
  }
}

void judge_flight_end(const StressTask& task, const LiveFlight& flight, VectorResult& result) {
  const auto& lost = flight.plant.divergence;
  if (!lost || fails_a_run(result.verdict)) return;
  const std::string how =
      fmt::format("the flight ended at {:.3f} s: {}", in_seconds(lost->at), lost->what);
  if (result.verdict == Verdict::pass) {
    return add_skip(result, how + "; until then the outputs agree with the reference's");
  }
  Case to_the_end = task.the_case;
  to_the_end.duration = {in_seconds(lost->at), Span::In::seconds};
  const auto again = open_reference({&to_the_end, task.vehicle_model.get()})
                         ->fly({task.configuration, flight.timing()});
  if (!again) return add_skip(result, how + "; " + again.error().to_string());
  if (again->fault) return add_skip(result, how);
  if (again->divergence) return add_skip(result, how + "; the reference loses the vehicle too");
  add(result, Verdict::fail, how + "; the reference does not lose the vehicle at the same times");
}

void judge_timing(const RealtimeBudget& budget, StressResult& stress) {
  const Verdict before = stress.result.verdict;
  judge_port(budget, stress);
  const bool port_fails = fails_a_run(stress.result.verdict) && !fails_a_run(before);
  if (port_fails) return;
  if (share_of(stress.plant_late_steps, stress.plant_steps) > plant_late_share) {
    add_skip(stress.result,
             fmt::format("this machine does not step the plant in real time: {} of {} steps too "
                         "late",
                         stress.plant_late_steps, stress.plant_steps));
  }
  judge_machine(budget, stress);
}

void judge_clock(const Wait& wait, const std::vector<LiveTick>& ticks, StressResult& stress) {
  // The unit's thread uses less than 20 us a tick for the messages and the record of the tick.
  constexpr Nanoseconds of_a_tick = std::chrono::microseconds(200);
  constexpr Nanoseconds of_the_rest = std::chrono::milliseconds(100);
  Nanoseconds steps{0};
  for (const LiveTick& tick : ticks) steps += tick.elapsed;
  const Nanoseconds own =
      static_cast<std::int64_t>(ticks.size()) * (of_a_tick + wait.spin) + of_the_rest;
  if (stress.unit_usage.cpu <= 2 * steps + own) return;
  add(stress.result, Verdict::protocol,
      fmt::format("the port's clock is wrong: by it, {} steps took {}, but their thread used {} of "
                  "CPU time",
                  ticks.size(), in_ms(steps), in_ms(stress.unit_usage.cpu)));
}

void judge_unit(const StressTask& task, Module module, LiveFlight& flight, bool of_end,
                StressResult& stress) {
  VectorResult& result = stress.result;
  LiveUnitRecord* unit = &flight.unit;
  const LiveUnitRecord* other = flight.attitude_unit ? &*flight.attitude_unit : nullptr;
  if (module == Module::attitude_unit) {
    unit = &*flight.attitude_unit;
    other = &flight.unit;
  }
  result.ticks = stress.ticks;
  result.elapsed_s = in_seconds(stress.wall);
  stress.timeline = flight_timeline(unit->ticks, limits_of(task.the_case.flight->realtime));
  if (unit->fault) return judge(*unit->fault, result);
  if (task.port.fixed_step) {
    add_skip(result, "outputs not judged: a fixed step does not follow the times of a real clock");
  } else {
    judge_outputs(task.the_case, module, *unit, task.port.fraction_bits, result);
  }
  if (other != nullptr && other->fault) {
    add_skip(result, "the flight ended at a fault of the other unit: " + other->fault->what);
  }
  if (of_end) judge_flight_end(task, flight, result);
  judge_clock(task.live.wait, unit->ticks, stress);
  judge_timing(task.the_case.flight->realtime, stress);
}

}  // namespace attest
