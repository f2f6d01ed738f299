#include "harness/report/time_document.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/json_text.hpp"
#include "harness/core/version.hpp"
#include "harness/report/html/histogram_plot.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

constexpr std::size_t slowest_in_text = 5, slowest_on_page = 20;

// The steps of all vectors of a group and module at a rate [Hz].
using GroupsByRate = std::map<std::string, std::map<double, Histogram>>;

GroupsByRate groups_of(const CorpusTimes& times) {
  GroupsByRate groups;
  for (const VectorTimes& vector : times.vectors) {
    if (!vector.is_timed()) continue;
    const VectorResult& result = vector.result;
    const std::string_view of_module =
        vector.module == Module::mc_att_control ? "" : info_of(vector.module).title;
    const std::string group = fmt::format("{}/{}{}{}", result.profile, result.group,
                                          of_module.empty() ? "" : ", ", of_module);
    Histogram& steps = groups[group][result.rate.hertz()];
    for (const Nanoseconds time : vector.steps) steps.add(time);
  }
  return groups;
}

std::optional<Verdict> against_budget(const TimeRun& run, Nanoseconds time) {
  if (!run.budget_us) return std::nullopt;
  return in_microseconds(time) > *run.budget_us ? Verdict::fail : Verdict::pass;
}

// A row for each module, because steps of different modules are not comparable.
DocumentTable modules_table(const CorpusTimes& times) {
  DocumentTable table{
      "Step times by module",
      {"", "min [us]", "median [us]", "p90 [us]", "p99 [us]", "p99.9 [us]", "max [us]"}};
  for (const auto& [module, steps] : times.by_module()) {
    table.rows.push_back({std::string(info_of(module).title), steps.min(), steps.percentile(0.5),
                          steps.percentile(0.9), steps.percentile(0.99), steps.percentile(0.999),
                          steps.max()});
  }
  return table;
}

// A row for each group, a column for each rate.
DocumentTable groups_table(const TimeRun& run) {
  const GroupsByRate groups = groups_of(run.times);
  std::set<double> rates;
  for (const auto& [name, by_rate] : groups) {
    for (const auto& [rate_hz, group] : by_rate) rates.insert(rate_hz);
  }
  DocumentTable table{"Slowest step by group and rate [us]; small: the median", {"group"}};
  table.rows_in_text = 0;
  for (const double rate_hz : rates) table.header.push_back(fmt::format("{:g} Hz", rate_hz));
  for (const auto& [name, by_rate] : groups) {
    std::vector<Cell> row = {name};
    for (const double rate_hz : rates) {
      Cell& cell = row.emplace_back();
      const auto group = by_rate.find(rate_hz);
      if (group == by_rate.end()) continue;
      const Histogram& steps = group->second;
      cell = Cell(steps.max(), against_budget(run, steps.max()));
      cell.small = Cell(steps.percentile(0.5)).text;
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

DocumentTable slowest_table(const TimeRun& run) {
  std::vector<const VectorTimes*> order;
  for (const VectorTimes& vector : run.times.vectors) {
    if (vector.is_timed()) order.push_back(&vector);
  }
  std::stable_sort(order.begin(), order.end(), [](const VectorTimes* a, const VectorTimes* b) {
    return a->slowest() > b->slowest();
  });
  order.resize(std::min(order.size(), slowest_on_page));
  DocumentTable table{"The slowest steps: one of each vector",
                      {"vector", "slowest step [us]", "at tick", "median [us]", "stack [bytes]"}};
  table.rows_in_text = slowest_in_text;
  for (const VectorTimes* vector : order) {
    const auto& stack = vector->stack_bytes;
    table.rows.push_back({vector->result.id(),
                          {vector->slowest(), against_budget(run, vector->slowest())},
                          fmt::to_string(vector->slowest_tick()),
                          vector->median(),
                          stack ? fmt::to_string(*stack) : "-"});
  }
  return table;
}

std::string instructions(std::vector<std::uint64_t> calls) {
  const auto worst = std::max_element(calls.begin(), calls.end()) - calls.begin();
  const std::uint64_t most = calls[static_cast<std::size_t>(worst)];
  std::sort(calls.begin(), calls.end());
  return fmt::format(
      "instructions of the slowest vector's steps, the same on every run: least {}, "
      "median {}, most {} (tick {})",
      calls.front(), calls[calls.size() / 2], most, worst);
}

// The failing vectors; those with the same reason as the one before are counted only.
std::vector<Note> failures_of(const CorpusTimes& times) {
  std::vector<Note> notes;
  std::string last_reason;
  std::size_t repeated = 0;
  const auto add_repeated = [&] {
    if (repeated > 0) notes.push_back({fmt::format("and {} more with the same reason", repeated)});
    repeated = 0;
  };
  for (const VectorTimes& vector : times.vectors) {
    const VectorResult& result = vector.result;
    if (!fails_a_run(result.verdict)) continue;
    if (!notes.empty() && result.reason == last_reason) {
      ++repeated;
      continue;
    }
    add_repeated();
    last_reason = result.reason;
    notes.push_back(
        {fmt::format("{} {}: {}", result.id(), name_of(result.verdict), result.reason), true});
  }
  add_repeated();
  return notes;
}

DocumentHead head_of(const TimeRun& run, bool any_fails) {
  const Histogram& steps = run.times.steps;
  const bool failed = any_fails || (run.budget_us && steps.over_limit() > run.allowed);
  const auto& vectors = run.times.vectors;
  const auto timed = std::count_if(vectors.begin(), vectors.end(),
                                   [](const VectorTimes& vector) { return vector.is_timed(); });
  std::string sentence = fmt::format(
      "{} steps of {}, each the shortest of {}; the time to read the clock ({}) is subtracted",
      steps.count(), counted(static_cast<std::size_t>(timed), "vector"),
      counted(static_cast<std::size_t>(run.repeats), "run"), human_time(run.times.clock));
  if (run.budget_us) {
    sentence += fmt::format("; {} of {} steps took longer than {:g} us, allowed {}",
                            steps.over_limit(), steps.count(), *run.budget_us, run.allowed);
  }
  return {failed ? Verdict::fail : Verdict::pass,
          failed          ? "fail"
          : run.budget_us ? "pass"
                          : "measured",
          fmt::format("Step times of {}", run.port), std::move(sentence)};
}

std::vector<PlotMark> budget_mark(const TimeRun& run) {
  if (!run.budget_us) return {};
  return {{*run.budget_us, "budget"}};
}

PlotGroup distribution(const TimeRun& run) {
  std::vector<NamedHistogram> modules;
  for (const auto& [module, steps] : run.times.by_module()) {
    modules.push_back({fmt::format("steps of the {}", info_of(module).title), steps.buckets()});
  }
  PlotGroup group{"All steps", "step time [us]", {}};
  group.plots = {histogram_plot("Step times", modules, budget_mark(run))};
  return group;
}

Plot by_rate(const TimeRun& run, Module module) {
  std::map<double, Histogram> steps;
  for (const VectorTimes& vector : run.times.vectors) {
    if (vector.module != module) continue;
    for (const Nanoseconds time : vector.steps) steps[vector.result.rate.hertz()].add(time);
  }
  PlotSeries slowest{"slowest step", {}, {}}, p99{"p99", {}, {}}, median{"median", {}, {}};
  PlotSeries budget{"budget", {}, {}, LinePattern::dashed, 4};
  const auto add = [](double rate_hz, double time_us, PlotSeries& series) {
    series.x.push_back(rate_hz);
    series.y.push_back(static_cast<float>(time_us));
  };
  for (const auto& [rate_hz, all] : steps) {
    add(rate_hz, in_microseconds(all.max()), slowest);
    if (supports_percentile(all.count(), 0.99)) {
      add(rate_hz, in_microseconds(all.percentile(0.99)), p99);
    }
    add(rate_hz, in_microseconds(all.percentile(0.5)), median);
    if (run.budget_us) add(rate_hz, *run.budget_us, budget);
  }
  Plot plot{fmt::format("Step times of the {} by loop rate", info_of(module).title), "us",
            "of all groups"};
  plot.logarithmic_x = plot.logarithmic_y = true;
  plot.series = {slowest, p99, median, budget};
  std::erase_if(plot.series, [](const PlotSeries& series) { return series.x.empty(); });
  return plot;
}

PlotGroup by_rate(const TimeRun& run) {
  PlotGroup group{"", "loop rate [Hz]", {}};
  for (const auto& [module, steps] : run.times.by_module()) {
    group.plots.push_back(by_rate(run, module));
  }
  return group;
}

using nlohmann::ordered_json;

ordered_json json_of(const VectorTimes& vector) {
  ordered_json out = {{"id", vector.result.id()},
                      {"module", name_of(vector.module)},
                      {"verdict", name_of(vector.result.verdict)}};
  if (!vector.is_timed()) return out;
  out["max_ns"] = vector.slowest().count();
  out["median_ns"] = vector.median().count();
  if (vector.stack_bytes) out["stack_bytes"] = *vector.stack_bytes;
  out["steps"] = vector.steps.size();
  out["worst_tick"] = vector.slowest_tick();
  return out;
}

ordered_json json_of(const Histogram& steps) {
  return {{"max_ns", steps.max().count()},
          {"median_ns", steps.percentile(0.5).count()},
          {"min_ns", steps.min().count()},
          {"p90_ns", steps.percentile(0.9).count()},
          {"p99_ns", steps.percentile(0.99).count()},
          {"p99_9_ns", steps.percentile(0.999).count()},
          {"steps", steps.count()}};
}

ordered_json json_of(const CorpusTimes& times) {
  ordered_json out = json_of(times.steps);
  out["clock_ns"] = times.clock.count();
  out["over_budget"] = times.steps.over_limit();
  if (const auto* most = times.with_most_stack()) out["stack_bytes"] = *most->stack_bytes;
  out["worst_tick"] = times.with_slowest_step()->slowest_tick();
  return out;
}

ordered_json modules_json(const CorpusTimes& times) {
  ordered_json out = ordered_json::object();
  for (const auto& [module, steps] : times.by_module()) {
    out[std::string(name_of(module))] = json_of(steps);
  }
  return out;
}

}  // namespace

Document time_document(const TimeRun& run) {
  const CorpusTimes& times = run.times;
  Document document;
  document.notes = failures_of(times);
  document.head = head_of(run, !document.notes.empty());
  document.facts = {{"attest", version},
                    {"port", run.port},
                    {"budget [us]", run.budget_us ? fmt::format("{:g}", *run.budget_us) : ""},
                    {"time to read the clock, subtracted", human_time(times.clock)}};
  if (times.steps.count() == 0) return document;
  if (const VectorTimes* most = times.with_most_stack()) {
    document.notes.push_back({fmt::format("stack of a step: at most {} bytes ({})",
                                          *most->stack_bytes, most->result.id())});
  }
  if (!run.instructions.empty()) document.notes.push_back({instructions(run.instructions)});
  document.tables = {modules_table(times), slowest_table(run), groups_table(run)};
  document.groups = {distribution(run), by_rate(run)};
  return document;
}

std::string time_json(const TimeRun& run) {
  ordered_json out = {{"schema", "attest-time-1"},
                      {"attest_version", version},
                      {"port", run.port},
                      {"repeats", run.repeats},
                      {"budget_us", nullptr},
                      {"all", json_of(run.times)},
                      {"modules", modules_json(run.times)},
                      {"slowest", run.times.with_slowest_step()->result.id()},
                      {"instructions", run.instructions},
                      {"vectors", ordered_json::array()}};
  if (run.budget_us) out["budget_us"] = *run.budget_us;
  for (const VectorTimes& vector : run.times.vectors) out["vectors"].push_back(json_of(vector));
  return document_of(out);
}

}  // namespace attest
