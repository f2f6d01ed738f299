#include "harness/report/time_document.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "harness/core/version.hpp"
#include "harness/report/html/histogram_plot.hpp"
#include "harness/report/shown_cost.hpp"
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

std::optional<Verdict> against_budget(const TimeRun& run, Cost cost) {
  const auto ns = Shown(run.counter).in_ns(cost);
  if (!run.budget_us || !ns) return std::nullopt;
  return *ns > *run.budget_us * 1000 ? Verdict::fail : Verdict::pass;
}

// A row for each module, because steps of different modules are not comparable.
DocumentTable modules_table(const TimeRun& run) {
  const Shown shown(run.counter);
  DocumentTable table{fmt::format("Step {}s by module", shown.what()), {""}};
  for (const char* name : {"min", "median", "p90", "p99", "p99.9", "max"}) {
    table.header.push_back(in_unit(name, shown));
  }
  for (const auto& [module, steps] : run.times.by_module()) {
    std::vector<Cell>& row = table.rows.emplace_back();
    row = {std::string(info_of(module).title), shown.cell(steps.min())};
    for (const double part : {0.5, 0.9, 0.99, 0.999}) {
      row.push_back(shown.cell(steps.percentile(part)));
    }
    row.push_back(shown.cell(steps.max()));
  }
  return table;
}

DocumentTable periods_table(const TimeRun& run, const std::vector<Period>& periods) {
  const Shown shown(run.counter);
  DocumentTable table{"Slowest step as a share of the period",
                      {"", "rate [Hz]", in_unit("slowest step", shown), "share [%]", "vector"}};
  if (!run.counter) table.rows_in_text = 0;
  for (const Period& one : periods) {
    const VectorTimes& vector = *one.slowest;
    table.rows.push_back({std::string(info_of(one.module).title), vector.result.rate.to_string(),
                          shown.cell(vector.slowest(), against_budget(run, vector.slowest())),
                          fmt::format("{:.3g}", 100 * one.share), vector.result.id()});
  }
  return table;
}

// For each module, the largest share of a period: "acme-fc at 168 MHz: 37% of 8000 Hz (rate unit)".
std::vector<Note> period_notes(const TimeRun& run, const std::vector<Period>& periods) {
  std::vector<Note> notes;
  if (!run.counter) return notes;
  std::map<Module, const Period*> largest;
  for (const Period& one : periods) {
    const Period*& found = largest[one.module];
    if (!found || one.share > found->share) found = &one;
  }
  const std::string clock = run.counter->clock_text();
  for (const auto& [module, period] : largest) {
    const VectorResult& result = period->slowest->result;
    notes.push_back({fmt::format("{}{}{}: {:.3g}% of {} Hz ({}, {})", run.port_name,
                                 clock.empty() ? "" : " at ", clock, 100 * period->share,
                                 result.rate.to_string(), info_of(module).title, result.id())});
  }
  return notes;
}

// A row for each group, a column for each rate.
DocumentTable groups_table(const TimeRun& run) {
  const GroupsByRate groups = groups_of(run.times);
  std::set<double> rates;
  for (const auto& [name, by_rate] : groups) {
    for (const auto& [rate_hz, group] : by_rate) rates.insert(rate_hz);
  }
  const Shown shown(run.counter);
  DocumentTable table{in_unit("Slowest step by group and rate", shown) + "; small: the median",
                      {"group"}};
  table.rows_in_text = 0;
  for (const double rate_hz : rates) table.header.push_back(fmt::format("{:g} Hz", rate_hz));
  for (const auto& [name, by_rate] : groups) {
    std::vector<Cell> row = {name};
    for (const double rate_hz : rates) {
      Cell& cell = row.emplace_back();
      const auto group = by_rate.find(rate_hz);
      if (group == by_rate.end()) continue;
      const Histogram& steps = group->second;
      cell = shown.cell(steps.max(), against_budget(run, steps.max()));
      cell.small = shown.cell(steps.percentile(0.5)).text;
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
  const Shown shown(run.counter);
  DocumentTable table{"The slowest steps: one of each vector",
                      {"vector", in_unit("slowest step", shown), "at tick",
                       in_unit("median", shown), "stack [bytes]"}};
  table.rows_in_text = slowest_in_text;
  for (const VectorTimes* vector : order) {
    const auto& stack = vector->stack_bytes;
    table.rows.push_back({vector->result.id(),
                          shown.cell(vector->slowest(), against_budget(run, vector->slowest())),
                          fmt::to_string(vector->slowest_tick()), shown.cell(vector->median()),
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

std::string how_measured(const TimeRun& run) {
  const std::string runs = counted(static_cast<std::size_t>(run.repeats), "run");
  if (!run.counter) {
    return fmt::format("each the shortest of {}; the time to read the clock ({}) is subtracted",
                       runs, human_time(run.times.clock));
  }
  std::string text = fmt::format("counted by the port in {}, in place of the host's clock",
                                 run.counter->to_string());
  if (run.repeats == 1) return text;
  std::size_t varying = 0;
  for (const VectorTimes& vector : run.times.vectors) varying += vector.varying;
  if (varying == 0) return text + fmt::format(", with equal counts in {}", runs);
  return text + fmt::format(", each the largest of {}; {} of the counts differ between them", runs,
                            varying);
}

// The changes that fail are errors; of the others, the largest growth comes first.
std::vector<Note> change_notes(const TimeRun& run) {
  constexpr std::size_t most = 20;
  std::vector<Note> notes;
  for (const CostChange& change : run.changes) {
    if (notes.size() == most) {
      notes.push_back({fmt::format("and {} more changes", run.changes.size() - most)});
      break;
    }
    notes.push_back({change.to_string(), change.fails});
  }
  if (!run.budget_file.empty() && notes.empty()) {
    notes.push_back({fmt::format("all worst costs are those of {}", run.budget_file)});
  }
  return notes;
}

DocumentHead head_of(const TimeRun& run, bool any_fails) {
  const Histogram& steps = run.times.steps;
  const bool has_budget = run.budget_us || !run.budget_file.empty();
  const bool failed = any_fails || (run.budget_us && steps.over_limit() > run.allowed);
  const auto& vectors = run.times.vectors;
  const auto timed = std::count_if(vectors.begin(), vectors.end(),
                                   [](const VectorTimes& vector) { return vector.is_timed(); });
  std::string sentence =
      fmt::format("{} steps of {}, {}", steps.count(),
                  counted(static_cast<std::size_t>(timed), "vector"), how_measured(run));
  if (run.budget_us) {
    sentence += fmt::format("; {} of {} steps took longer than {:g} us, allowed {}",
                            steps.over_limit(), steps.count(), *run.budget_us, run.allowed);
    const double slowest_us = Shown(run.counter).in_ns(steps.max()).value_or(0) / 1000;
    sentence += fmt::format("; the slowest takes {:.3g}% of it", 100 * slowest_us / *run.budget_us);
  }
  return {failed       ? Conclusion::fail
          : has_budget ? Conclusion::pass
                       : Conclusion::measured,
          fmt::format("Step {}s of {}", Shown(run.counter).what(), run.port), std::move(sentence)};
}

std::vector<PlotMark> budget_mark(const TimeRun& run) {
  if (!run.budget_us) return {};
  return {{Shown(run.counter).number_of_us(*run.budget_us), "budget"}};
}

PlotGroup distribution(const TimeRun& run) {
  std::vector<NamedHistogram> modules;
  for (const auto& [module, steps] : run.times.by_module()) {
    modules.push_back({fmt::format("steps of the {}", info_of(module).title), steps.buckets()});
  }
  const Shown shown(run.counter);
  PlotGroup group{"All steps", in_unit(fmt::format("step {}", shown.what()), shown), {}};
  group.plots = {histogram_plot(fmt::format("Step {}s", shown.what()), modules, budget_mark(run),
                                shown.scale())};
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
  const Shown shown(run.counter);
  const auto add = [](double rate_hz, double cost, PlotSeries& series) {
    series.x.push_back(rate_hz);
    series.y.push_back(static_cast<float>(cost));
  };
  for (const auto& [rate_hz, all] : steps) {
    add(rate_hz, shown.number(all.max()), slowest);
    if (supports_percentile(all.count(), 0.99)) {
      add(rate_hz, shown.number(all.percentile(0.99)), p99);
    }
    add(rate_hz, shown.number(all.percentile(0.5)), median);
    if (run.budget_us) add(rate_hz, shown.number_of_us(*run.budget_us), budget);
  }
  Plot plot{fmt::format("Step {}s of the {} by loop rate", shown.what(), info_of(module).title),
            std::string(shown.unit()), "of all groups"};
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

}  // namespace

Document time_document(const TimeRun& run) {
  const CorpusTimes& times = run.times;
  Document document;
  document.notes = failures_of(times);
  const bool has_grown =
      std::ranges::any_of(run.changes, [](const CostChange& change) { return change.fails; });
  document.head = head_of(run, !document.notes.empty() || has_grown);
  document.facts = {
      {"attest", version},
      {"port", run.port},
      {"budget [us]", run.budget_us ? fmt::format("{:g}", *run.budget_us) : ""},
      {"budget file", run.budget_file},
      {"counted by the port", run.counter ? run.counter->to_string() : ""},
      {"time to read the clock, subtracted", run.counter ? "" : human_time(times.clock)}};
  if (times.steps.count() == 0) return document;
  const std::vector<Period> periods = periods_of(run);
  for (const auto& notes : {change_notes(run), period_notes(run, periods)}) {
    document.notes.insert(document.notes.end(), notes.begin(), notes.end());
  }
  if (const VectorTimes* most = times.with_most_stack()) {
    document.notes.push_back(
        {run.counter ? fmt::format("stack: {} bytes, the high-water mark that the port reports",
                                   *most->stack_bytes)
                     : fmt::format("stack of a step: at most {} bytes ({})", *most->stack_bytes,
                                   most->result.id())});
  }
  if (!run.instructions.empty()) document.notes.push_back({instructions(run.instructions)});
  document.tables = {modules_table(run), slowest_table(run), groups_table(run)};
  if (!periods.empty()) document.tables.push_back(periods_table(run, periods));
  document.groups = {distribution(run), by_rate(run)};
  return document;
}

}  // namespace attest
