#include "harness/suite/stress.hpp"

#include <utility>

#include <fmt/format.h>

#include "harness/port/builtin.hpp"
#include "harness/run/margins.hpp"
#include "harness/run/open_loop.hpp"
#include "harness/run/timing_file.hpp"
#include "harness/suite/evaluate.hpp"
#include "harness/suite/judge.hpp"

namespace attest {
namespace {

// Of so many ticks the outputs are kept and checked: half a minute at 8 kHz, 80 MB.
constexpr std::size_t checked_ticks = 1u << 18;
// A plant that falls behind more often than this is not the plant of the case.
constexpr double plant_late_share = 0.01;

double micros(Nanoseconds time) { return static_cast<double>(time.count()) / 1000; }

// The reference, given the same inputs at the same times: late and missing ticks are no excuse for
// another output. A decision of the law on a threshold is.
void check_outputs(const Case& the_case, LiveUnitRecord& unit, std::optional<int> fraction_bits,
                   CaseResult& result) {
  Trace got;
  got.present = channels_of(Part::mc_att_control);
  got.samples = std::move(unit.samples);
  got.parameters = std::move(unit.changes);
  if (got.samples.empty()) return;
  Trace want = got;
  const auto reference_port = open_builtin();
  const auto reference = reference_port->create(the_case.profile);
  if (!reference || drive(*reference, want)) return;
  const DefaultFloatEnvironment environment;
  judge(compare(got, want, tolerances_of(the_case, Level::numeric, fraction_bits)), result);
  if (result.verdict == Verdict::pass) return;
  const Margins near = margins(got, subject_of(the_case));
  for (std::size_t i = 0; i < decision_count; ++i) {
    const auto decision = static_cast<Decision>(i);
    if (near.is_safe(decision) || near[decision].tick > result.first.value_or(Deviation{}).tick) {
      continue;
    }
    result.verdict = Verdict::pass;
    result.reason = fmt::format("outputs not judged: tick {} came too near to a decision ({})",
                                near[decision].tick, name_of(decision));
  }
}

struct Missed {
  std::string what;
  bool by_machine = false;
};

std::optional<Missed> missed_budget(const RealtimeBudget& budget, const StressResult& result) {
  const double allowed = budget.misses_per_million;
  if (const double over = result.per_million(result.over_budget); over > allowed) {
    return Missed{fmt::format("{} steps took longer than {:g} us: {:.0f} per million, budget {:g}",
                              result.over_budget, *budget.execution_us, over, allowed)};
  }
  const bool by_steps = result.per_million(result.missed_by_steps) > allowed;
  if (const double missed = result.per_million(result.missed); missed > allowed) {
    return Missed{
        fmt::format("{} of {} deadlines missed: {:.0f} per million, budget {:g}; {} of "
                    "them after a step that took half a period or more",
                    result.missed, result.deadlines, missed, allowed, result.missed_by_steps),
        !by_steps};
  }
  // A wake-up is late by the machine, but for those that a step before it held up.
  if (const double late = micros(result.lateness.p99); late > budget.p99_lateness_us) {
    return Missed{fmt::format("p99 of the wake-up lateness is {:.3g} us, budget {:g}; of the idle "
                              "machine {:.3g}",
                              late, budget.p99_lateness_us, micros(result.idle.p99)),
                  result.missed_by_steps == 0};
  }
  return std::nullopt;
}

void judge_timing(const RealtimeBudget& budget, StressResult& stress) {
  CaseResult& result = stress.result;
  if (result.verdict != Verdict::pass) return;
  const auto late = static_cast<double>(stress.plant_late_steps);
  if (late > plant_late_share * static_cast<double>(stress.plant_steps)) {
    result.verdict = Verdict::skip;
    result.reason = fmt::format(
        "this machine does not step the plant in real time: {} of {} steps "
        "too late",
        stress.plant_late_steps, stress.plant_steps);
    return;
  }
  const auto missed = missed_budget(budget, stress);
  if (!missed) return;
  result.verdict = missed->by_machine ? Verdict::skip : Verdict::fail;
  result.reason = (missed->by_machine ? "the machine's, not the port's: " : "") + missed->what;
}

// One wait a tick is the loop's own, for its deadline.
bool waits_in_steps(const LiveUnitRecord& unit) {
  const auto ticks = static_cast<std::int64_t>(unit.ticks.size());
  return unit.usage.yields > ticks + ticks / 100 + 10;
}

// What the histograms and counters of a flight say.
void summarise(const LiveFlight& flight, const Rate& rate, const RealtimeBudget& budget,
               StressResult& stress) {
  const LiveUnitRecord& unit = flight.unit;
  stress.lateness = spread_of(unit.lateness);
  stress.execution = spread_of(unit.execution);
  stress.age = spread_of(unit.age);
  stress.plant = spread_of(flight.plant.lateness);
  stress.ticks = unit.ticks.size();
  stress.deadlines = unit.ticks.size() + unit.missed;
  stress.overruns = unit.overruns;
  stress.missed = unit.missed;
  stress.waits = waits_in_steps(unit);
  for (const LiveTick& tick : unit.ticks) {
    const Nanoseconds own = stress.waits ? tick.execution : tick.cpu;
    if (own >= rate.tick(1) / 2) stress.missed_by_steps += tick.missed;
    if (budget.execution_us && micros(own) > *budget.execution_us) ++stress.over_budget;
  }
  stress.plant_steps = flight.plant.steps;
  stress.plant_late_steps = flight.plant.late_steps;
  stress.longest_gap = unit.longest_gap;
  stress.wall = flight.wall;
  stress.unit_usage = unit.usage;
  stress.plant_usage = flight.plant.usage;
  stress.rights = flight.rights;
  stress.slow = slow_ticks(unit.ticks, stress.execution.median);
}

}  // namespace

Spread spread_of(const Histogram& histogram) {
  return {histogram.count(),
          histogram.min(),
          histogram.percentile(0.5),
          histogram.percentile(0.9),
          histogram.percentile(0.99),
          histogram.percentile(0.999),
          histogram.max()};
}

double StressResult::per_million(std::uint64_t count) const {
  return deadlines == 0 ? 0 : 1e6 * static_cast<double>(count) / static_cast<double>(deadlines);
}

Result<StressResult> stress_here(const StressTask& task, Port& port,
                                 const std::function<bool()>& stop,
                                 const std::function<void(const StressProgress&)>& progress) {
  StressResult stress;
  CaseResult& result = stress.result = unjudged(task.the_case, task.setup);
  if (port.fixed_step() && *port.fixed_step() != task.setup.rate) {
    result.verdict = Verdict::unsupported;
    result.reason =
        fmt::format("the port has a fixed step of {} Hz", port.fixed_step()->to_string());
    return stress;
  }
  const auto unit = create_unit(port, task.the_case.profile, result);
  if (!unit) return stress;
  progress({{}, true});
  const Histogram idle = idle_lateness(task.setup.rate, task.idle_duration, task.live, stop);
  auto flight = fly_live(task.the_case, task.setup, *task.airframe, *unit, task.live, checked_ticks,
                         stop, [&](const LiveProgress& live) {
                           progress({live, false});
                         });
  if (!flight) return tl::unexpected(flight.error());

  const RealtimeBudget& budget = task.the_case.flight->realtime;
  stress.idle = spread_of(idle);
  summarise(*flight, task.setup.rate, budget, stress);
  if (!task.record_timing.empty()) {
    const TimingFile timing{task.the_case.id(), task.the_case.sha256, task.setup,
                            task.the_case.duration.amount, flight->timing()};
    if (auto written = write_timing(timing, task.record_timing); !written) {
      return tl::unexpected(written.error());
    }
  }
  result.ticks = stress.ticks;
  result.elapsed_s = in_seconds(stress.wall);
  if (flight->unit.fault) {
    judge(*flight->unit.fault, result);
    return stress;
  }
  if (port.fixed_step()) {
    result.reason = "outputs not judged: a fixed step does not follow the times of a real clock";
  } else {
    check_outputs(task.the_case, flight->unit, port.fraction_bits(), result);
  }
  if (const auto& lost = flight->plant.divergence; lost && result.verdict == Verdict::pass) {
    result.verdict = Verdict::fail;
    result.reason =
        fmt::format("the flight ended at {:.3f} s: {}", in_seconds(lost->at), lost->what);
  }
  judge_timing(budget, stress);
  return stress;
}

}  // namespace attest
