#include "harness/report/html/stress_page.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "harness/core/version.hpp"
#include "harness/report/html/histogram_plot.hpp"
#include "harness/report/html/plot_page.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

std::string time_cell(const std::optional<Nanoseconds>& time) {
  return time ? fmt::format("{:.4g}", microseconds(*time)) : "-";
}

// "1000 Hz", or "250:1000 Hz, attitude unit".
std::string heading_of(const StressResult& stress) {
  const std::string rate = stress.result.rate.to_string();
  return stress.module ? fmt::format("{} Hz, {}", rate, info_of(*stress.module).title)
                       : rate + " Hz";
}

std::vector<PageCell> rate_row(const StressResult& stress) {
  const VectorResult& result = stress.result;
  const DeadlineMisses& misses = stress.misses;
  if (stress.ticks == 0) {
    return {rate_of(stress), {std::string(name_of(result.verdict)), result.verdict}};
  }
  return {rate_of(stress),
          {std::string(name_of(result.verdict)), result.verdict},
          time_cell(stress.idle.p99),
          time_cell(stress.idle.max),
          time_cell(stress.latency.p99),
          time_cell(stress.latency.max),
          time_cell(stress.execution.median),
          time_cell(stress.execution.p99),
          time_cell(stress.execution.max),
          time_cell(stress.response.max),
          fmt::to_string(stress.deadlines),
          fmt::to_string(misses.total()),
          fmt::to_string(misses.by_port),
          fmt::to_string(stress.overruns),
          fmt::to_string(misses.late_starts)};
}

PageTable rates_table(const StressRun& run) {
  PageTable table{"Rates; times in us",
                  {"rate [Hz]", "verdict", "idle p99", "idle max", "latency p99", "latency max",
                   "execution median", "execution p99", "execution max", "response max",
                   "deadlines", "missed", "by the port", "overruns", "late starts"}};
  for (const StressResult& stress : run.results) table.rows.push_back(rate_row(stress));
  return table;
}

PageTable worst_table(const StressResult& stress) {
  PageTable table{fmt::format("{}: longest responses; times in us", heading_of(stress)),
                  {"tick", "released at [s]", "latency", "execution", "response", "skipped"}};
  for (const auto& [number, tick] : stress.timeline.worst) {
    table.rows.push_back({fmt::to_string(number), fmt::format("{:.4f}", in_seconds(tick.release)),
                          time_cell(tick.latency()), time_cell(tick.execution()),
                          time_cell(tick.response()), fmt::to_string(tick.skipped)});
  }
  return table;
}

PlotMark period_mark(const StressResult& stress) {
  return {1e6 / stress.unit_rate().hertz(), "period"};
}

PlotGroup distributions(const StressRun& run, const StressResult& stress) {
  std::vector<PlotMark> latency = {{run.budget.p99_latency_us, "budget of p99"}};
  if (stress.cyclictest) {
    latency.push_back({microseconds(stress.cyclictest->max), "cyclictest, max"});
  }
  std::vector<PlotMark> execution = {period_mark(stress)};
  if (run.budget.execution_us) execution.push_back({*run.budget.execution_us, "budget"});
  PlotGroup group{
      fmt::format("{}: {}", heading_of(stress), name_of(stress.result.verdict)), "time [us]", {}};
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
    series.y.push_back(static_cast<float>(microseconds(part.*figure)));
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

std::string granted(const StressResult& stress, bool wanted) {
  std::string out;
  for (const auto& [name, got, why] : stress.privileges) {
    if (got != wanted) continue;
    out += fmt::format("{}{}{}", out.empty() ? "" : ", ", name, got ? "" : " (" + why + ")");
  }
  return out;
}

std::vector<PageFact> facts_of(const StressRun& run) {
  std::vector<PageFact> facts = {
      {"attest", version},
      {"port", run.port},
      {"load", run.load},
      {"scheduling policy asked for", run.live.fifo ? "fifo" : "other"},
      {"CPU of unit, of plant", fmt::format("{}, {}", run.live.unit_cpu, run.live.plant_cpu)},
      {"budget of p99 of the latency [us]", fmt::format("{:g}", run.budget.p99_latency_us)},
      {"budget of misses per million", fmt::format("{:g}", run.budget.misses_per_million)}};
  if (run.budget.execution_us) {
    facts.push_back(
        {"budget of the execution time [us]", fmt::format("{:g}", *run.budget.execution_us)});
  }
  if (run.results.empty()) return facts;
  facts.push_back({"privileges granted", granted(run.results.front(), true)});
  facts.push_back({"privileges refused", granted(run.results.front(), false)});
  return facts;
}

Verdict verdict_for_page(const StressRun& run) {
  const std::string_view word = verdict_of(run);
  return word == "pass" ? Verdict::pass : word == "fail" ? Verdict::fail : Verdict::skip;
}

}  // namespace

std::string stress_page(const StressRun& run) {
  const RunResult all = run_of(run);
  PlotPage page;
  page.conclusion = {verdict_for_page(run), std::string(verdict_of(run)),
                     fmt::format("{} {} in real time", all.port_name, all.port_version),
                     fmt::format("{} of {} hold (load: {}){}", all.count(Verdict::pass),
                                 counted(all.results.size(), "rate"), run.load,
                                 run.interrupted ? "; interrupted" : "")};
  page.facts = facts_of(run);
  page.tables = {rates_table(run)};
  if (const std::string note = note_on_units(run); !note.empty()) {
    page.notes.push_back({note, false});
  }
  for (const StressResult& stress : run.results) {
    const VectorResult& result = stress.result;
    if (!result.reason.empty()) {
      page.notes.push_back(
          {fmt::format("{}: {}: {}", heading_of(stress), name_of(result.verdict), result.reason),
           fails_a_run(result.verdict)});
    }
    if (stress.ticks == 0) continue;
    page.groups.push_back(distributions(run, stress));
    if (stress.timeline.parts.empty()) continue;
    page.groups.push_back(timeline(run, stress));
    page.tables.push_back(worst_table(stress));
  }
  return plot_page(page);
}

}  // namespace attest
