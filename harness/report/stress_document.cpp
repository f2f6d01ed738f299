#include "harness/report/stress_document.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/core/version.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/html/histogram_plot.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

// ", attitude unit"; empty for the controller.
std::string of_unit(const StressResult& stress) {
  return stress.module ? fmt::format(", {}", info_of(*stress.module).title) : "";
}

// "1000 Hz", or "250:1000 Hz, attitude unit". `unit`: " Hz", or empty.
std::string rate_of(const StressResult& stress, std::string_view unit) {
  return fmt::format("{}{}{}", stress.result.rate.to_string(), unit, of_unit(stress));
}

Cell verdict_cell(const VectorResult& result) {
  return {std::string(name_of(result.verdict)), result.verdict};
}

DocumentTable rates_table(const StressRun& run) {
  DocumentTable table{
      "Rates",
      {"rate [Hz]", "verdict", "idle p99 [us]", "idle max [us]", "latency p99 [us]",
       "latency max [us]", "execution median [us]", "execution p99 [us]", "execution max [us]",
       "response max [us]", "deadlines", "missed", "by the port", "overruns", "late starts"}};
  for (const StressResult& stress : run.results) {
    std::vector<Cell> row = {rate_of(stress, ""), verdict_cell(stress.result)};
    if (stress.ticks > 0) {
      for (const auto& time :
           {stress.idle.p99, std::optional(stress.idle.max), stress.latency.p99,
            std::optional(stress.latency.max), stress.execution.median, stress.execution.p99,
            std::optional(stress.execution.max), std::optional(stress.response.max)}) {
        row.emplace_back(time);
      }
      for (const std::uint64_t count :
           {stress.deadlines, stress.misses.total(), stress.misses.by_port, stress.overruns,
            stress.misses.late_starts}) {
        row.emplace_back(fmt::to_string(count));
      }
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

DocumentTable worst_table(const StressResult& stress) {
  DocumentTable table{
      fmt::format("{}: longest responses", rate_of(stress, " Hz")),
      {"tick", "released at [s]", "latency [us]", "execution [us]", "response [us]", "skipped"}};
  for (const auto& [number, tick] : stress.timeline.worst) {
    table.rows.push_back({fmt::to_string(number), fmt::format("{:.4f}", in_seconds(tick.release)),
                          tick.latency(), tick.execution(), tick.response(),
                          fmt::to_string(tick.skipped)});
  }
  return table;
}

double share(Nanoseconds part, Nanoseconds whole) {
  return whole.count() == 0
             ? 0
             : 100 * static_cast<double>(part.count()) / static_cast<double>(whole.count());
}

std::string cyclictest_text(const StressResult& stress) {
  const auto theirs = static_cast<double>(stress.cyclictest->median.count());
  const auto ours = static_cast<double>(stress.idle.median->count());
  return fmt::format("idle machine: {:.2f} times the median of cyclictest", ours / theirs);
}

std::string deadlines_text(const StressResult& stress) {
  const DeadlineMisses& misses = stress.misses;
  return fmt::format(
      "{} deadlines, {} missed ({:.0f} per million): {} late responses, {} skipped releases; {} of "
      "them by the port's execution time; {} overruns; longest gap {}",
      stress.deadlines, misses.total(), stress.per_million(misses.total()), misses.late,
      misses.skipped, misses.by_port, stress.overruns, human_time(stress.longest_gap));
}

std::string usage_text(const StressResult& stress) {
  const Usage& unit = stress.unit_usage;
  return fmt::format(
      "unit: {:.1f}% CPU, {} waits, {} preemptions, {} page faults, {} allocations; plant: {:.1f}% "
      "CPU, {} of {} steps too late",
      share(unit.cpu, stress.wall), unit.yields, unit.preemptions, unit.page_faults,
      unit.allocations, share(stress.plant_usage.cpu, stress.wall), stress.plant_late_steps,
      stress.plant_steps);
}

void add_slow_steps(const SlowTicks& slow, std::vector<Cell>& lines) {
  if (slow.count == 0) return;
  std::vector<std::string> worst;
  for (const auto& [tick, execution, elapsed] : slow.worst) {
    worst.push_back(fmt::format("tick {} ({})", tick, human_time(execution)));
  }
  lines.emplace_back(fmt::format("slow steps: {} over {} of execution time: {}", slow.count,
                                 human_time(slow.threshold), fmt::join(worst, ", ")));
  if (const auto& rhythm = slow.rhythm) {
    lines.emplace_back(
        fmt::format("they come every {} steps, from tick {} on (chance: below {:.1g})",
                    rhythm->every, rhythm->first, std::max(rhythm->chance, 1e-12)));
  }
}

void add_outputs(const VectorResult& result, std::vector<Cell>& lines) {
  if (result.deviating_ticks > 0 || result.first) {
    for (const std::string& line : lines_of(finding_text(result, Level::numeric))) {
      lines.emplace_back(line.substr(2));
    }
  } else if (result.tightest) {
    lines.emplace_back(fmt::format(
        "outputs agree with the reference's for the same inputs and times, headroom {:.3g}",
        result.tightest->ratio));
  } else {
    lines.emplace_back("outputs equal the reference's for the same inputs and times");
  }
}

PlotMark period_mark(const StressResult& stress) {
  return {1e6 / stress.unit_rate().hertz(), "period"};
}

PlotGroup distributions(const StressRun& run, const StressResult& stress) {
  std::vector<PlotMark> latency = {{run.budget.p99_latency_us, "budget of p99"}};
  if (stress.cyclictest) {
    latency.push_back({in_microseconds(stress.cyclictest->max), "cyclictest, max"});
  }
  std::vector<PlotMark> execution = {period_mark(stress)};
  if (run.budget.execution_us) execution.push_back({*run.budget.execution_us, "budget"});
  PlotGroup group{fmt::format("{}: {}", rate_of(stress, " Hz"), name_of(stress.result.verdict)),
                  "time [us]",
                  {}};
  group.plots = {
      histogram_plot("Wake-up latency",
                     {{"idle machine", stress.idle.buckets}, {"in flight", stress.latency.buckets}},
                     std::move(latency)),
      histogram_plot("Execution time", {{"execution time", stress.execution.buckets}},
                     std::move(execution)),
      histogram_plot("Response time", {{"response time", stress.response.buckets}},
                     {period_mark(stress)}),
      histogram_plot("Age of the sample at the finish", {{"sample age", stress.age.buckets}}, {})};
  return group;
}

using Figure = Nanoseconds TimelinePart::*;
using Count = std::uint64_t TimelinePart::*;

PlotSeries longest(const StressResult& stress, const char* name, Figure figure) {
  PlotSeries series{name, {}, {}};
  for (const TimelinePart& part : stress.timeline.parts) {
    series.x.push_back(in_seconds(part.begin));
    series.y.push_back(static_cast<float>(in_microseconds(part.*figure)));
  }
  return series;
}

// A part without an event has no point. A series without any event is empty.
PlotSeries events(const StressResult& stress, const char* name, Count count) {
  PlotSeries series{name, {}, {}};
  for (const TimelinePart& part : stress.timeline.parts) {
    const auto value = static_cast<float>(part.*count);
    series.x.push_back(in_seconds(part.begin));
    series.y.push_back(value > 0 ? value : std::numeric_limits<float>::quiet_NaN());
  }
  const bool is_empty =
      std::all_of(series.y.begin(), series.y.end(), [](float value) { return std::isnan(value); });
  return is_empty ? PlotSeries{name, {}, {}} : series;
}

PlotSeries level(const StressResult& stress, const char* name, double value) {
  const auto& parts = stress.timeline.parts;
  const auto y = static_cast<float>(value);
  return {name,
          {in_seconds(parts.front().begin), in_seconds(parts.back().begin)},
          {y, y},
          LinePattern::dashed,
          4};
}

PlotGroup timeline(const StressRun& run, const StressResult& stress) {
  Plot times{"Longest times", "us",
             fmt::format("of each of {} parts of the flight", stress.timeline.parts.size())};
  times.shape = PlotShape::steps;
  times.logarithmic_y = true;
  times.series = {longest(stress, "wake-up latency", &TimelinePart::latency),
                  longest(stress, "execution time", &TimelinePart::execution),
                  longest(stress, "response time", &TimelinePart::response),
                  level(stress, "period", 1e6 / stress.unit_rate().hertz())};
  if (run.budget.execution_us) {
    times.series.push_back(level(stress, "budget of the execution time", *run.budget.execution_us));
  }
  Plot plot{"Overruns, deadline misses, late starts", "count in each part"};
  plot.shape = PlotShape::points;
  plot.series = {events(stress, "overruns", &TimelinePart::overruns),
                 events(stress, "late responses", &TimelinePart::late),
                 events(stress, "skipped releases", &TimelinePart::skipped),
                 events(stress, "late starts", &TimelinePart::late_starts)};
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    plot.series[i].colour = static_cast<int>(i);
  }
  std::erase_if(plot.series, [](const PlotSeries& series) { return series.x.empty(); });
  PlotGroup group{"", "time of the flight [s]", {times}};
  if (!plot.series.empty()) group.plots.push_back(std::move(plot));
  return group;
}

// "mlockall, SCHED_FIFO 80 (not permitted)", of the privileges that were granted or refused.
std::string privileges(const StressResult& stress, bool granted) {
  std::vector<std::string> names;
  for (const auto& [name, has, why] : stress.privileges) {
    if (has == granted) names.push_back(has ? name : fmt::format("{} ({})", name, why));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

std::vector<Fact> facts_of(const StressRun& run) {
  std::vector<Fact> facts = {
      {"attest", version},
      {"port", run.port},
      {"load", run.load},
      {"scheduling policy asked for", run.live.fifo ? "fifo" : "other"},
      {"CPU of unit, of plant", fmt::format("{}, {}", run.live.unit_cpu, run.live.plant_cpu)},
      {"budget of p99 of the latency [us]", fmt::format("{:g}", run.budget.p99_latency_us)},
      {"budget of misses per million", fmt::format("{:g}", run.budget.misses_per_million)},
      {"budget of the execution time [us]",
       run.budget.execution_us ? fmt::format("{:g}", *run.budget.execution_us) : ""}};
  if (run.results.empty()) return facts;
  for (Fact& fact : privileges_of(run.results.front())) facts.push_back(std::move(fact));
  return facts;
}

}  // namespace

std::vector<Fact> privileges_of(const StressResult& stress) {
  return {{"privileges granted", privileges(stress, true)},
          {"privileges refused", privileges(stress, false)}};
}

DocumentTable result_table(const StressResult& stress) {
  const VectorResult& result = stress.result;
  DocumentTable table{result.id() + of_unit(stress),
                      {"", "median [us]", "p90 [us]", "p99 [us]", "p99.9 [us]", "max [us]"}};
  if (stress.ticks > 0) {
    if (const auto& theirs = stress.cyclictest) {
      table.rows.push_back({"cyclictest, idle", theirs->median, "", "", "", theirs->max});
    }
    for (const auto& [name, times] :
         {std::pair("idle machine", &stress.idle), std::pair("wake-up latency", &stress.latency),
          std::pair("execution time", &stress.execution),
          std::pair("response time", &stress.response), std::pair("sample age", &stress.age),
          std::pair("plant's wake-up", &stress.plant)}) {
      if (times->count == 0) continue;
      table.rows.push_back({name, times->median, times->p90, times->p99, times->p999, times->max});
    }
    if (stress.cyclictest && stress.idle.median) table.below.emplace_back(cyclictest_text(stress));
    table.below.emplace_back(deadlines_text(stress));
    table.below.emplace_back(usage_text(stress));
    add_slow_steps(stress.slow, table.below);
    add_outputs(result, table.below);
  }
  table.below.push_back(verdict_cell(result));
  if (!result.reason.empty()) table.below.back().text += ": " + one_line(result.reason);
  return table;
}

Document stress_document(const StressRun& run) {
  const RunResult all = run_of(run);
  Document document;
  document.head = {conclusion_of(run),
                   fmt::format("{} {} in real time", all.port_name, all.port_version),
                   fmt::format("{} of {} hold in real time (load: {})", all.count(Verdict::pass),
                               counted(all.results.size(), "rate"), run.load)};
  if (const auto rates = rates_not_judged(run); !rates.empty()) {
    document.head.sentence += fmt::format("; not judged: {} Hz", fmt::join(rates, " Hz, "));
  }
  if (run.interrupted) document.head.sentence += "; interrupted";
  document.facts = facts_of(run);
  document.tables = {rates_table(run)};
  for (std::string note : {note_on_units(run), note_on_cost(run)}) {
    if (!note.empty()) document.notes.push_back({std::move(note)});
  }
  for (const StressResult& stress : run.results) {
    const VectorResult& result = stress.result;
    if (!result.reason.empty()) {
      document.notes.push_back({fmt::format("{}: {}: {}", rate_of(stress, " Hz"),
                                            name_of(result.verdict), result.reason),
                                fails_a_run(result.verdict)});
    }
    document.tables.push_back(result_table(stress));
    if (stress.ticks == 0) continue;
    document.groups.push_back(distributions(run, stress));
    if (stress.timeline.parts.empty()) continue;
    document.groups.push_back(timeline(run, stress));
    document.tables.push_back(worst_table(stress));
  }
  return document;
}

}  // namespace attest
