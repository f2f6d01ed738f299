#include "harness/report/html/time_page.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "harness/core/version.hpp"
#include "harness/report/html/histogram_plot.hpp"
#include "harness/report/html/plot_page.hpp"
#include "harness/report/stress_text.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

constexpr std::size_t slowest_listed = 20;

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

std::string us_cell(Nanoseconds time) { return fmt::format("{:.4g}", microseconds(time)); }

std::optional<Verdict> against_budget(const TimeRun& run, Nanoseconds time) {
  if (!run.budget_us) return std::nullopt;
  return microseconds(time) > *run.budget_us ? Verdict::fail : Verdict::pass;
}

// A row for each group, a column for each rate.
PageTable groups_table(const TimeRun& run, const GroupsByRate& groups) {
  std::set<double> rates;
  for (const auto& [name, by_rate] : groups) {
    for (const auto& [rate_hz, group] : by_rate) rates.insert(rate_hz);
  }
  PageTable table{"Slowest step by group and rate [us]; small: the median", {"group"}};
  for (const double rate_hz : rates) table.header.push_back(fmt::format("{:g} Hz", rate_hz));
  for (const auto& [name, by_rate] : groups) {
    std::vector<PageCell> row = {name};
    for (const double rate_hz : rates) {
      const auto group = by_rate.find(rate_hz);
      if (group == by_rate.end()) {
        row.emplace_back("");
        continue;
      }
      const Histogram& steps = group->second;
      row.emplace_back(us_cell(steps.max()), against_budget(run, steps.max()),
                       us_cell(steps.percentile(0.5)));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

PageTable slowest_table(const TimeRun& run) {
  std::vector<const VectorTimes*> order;
  for (const VectorTimes& vector : run.times.vectors) {
    if (vector.is_timed()) order.push_back(&vector);
  }
  std::stable_sort(order.begin(), order.end(), [](const VectorTimes* a, const VectorTimes* b) {
    return a->slowest() > b->slowest();
  });
  order.resize(std::min(order.size(), slowest_listed));
  PageTable table{"Slowest vectors; times in us",
                  {"vector", "slowest step", "at tick", "median", "stack [bytes]"}};
  for (const VectorTimes* vector : order) {
    const auto& stack = vector->stack_bytes;
    table.rows.push_back({vector->result.id(),
                          {us_cell(vector->slowest()), against_budget(run, vector->slowest())},
                          fmt::to_string(vector->slowest_tick()),
                          us_cell(vector->median()),
                          stack ? fmt::to_string(*stack) : "-"});
  }
  return table;
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
    add(rate_hz, microseconds(all.max()), slowest);
    if (supports_percentile(all.count(), 0.99)) {
      add(rate_hz, microseconds(all.percentile(0.99)), p99);
    }
    add(rate_hz, microseconds(all.percentile(0.5)), median);
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

}  // namespace

std::string time_page(const TimeRun& run) {
  const CorpusTimes& times = run.times;
  const GroupsByRate groups = groups_of(times);
  PlotPage page;
  for (const VectorTimes& vector : times.vectors) {
    if (!fails_a_run(vector.result.verdict)) continue;
    page.notes.push_back({fmt::format("{} {}: {}", vector.result.id(),
                                      name_of(vector.result.verdict), vector.result.reason),
                          true});
  }
  const bool over = run.budget_us && times.steps.over_limit() > run.allowed;
  const bool failed = over || !page.notes.empty();
  std::string sentence =
      fmt::format("{} steps, each the shortest of {}: median {}, max {}", times.steps.count(),
                  counted(static_cast<std::size_t>(run.repeats), "run"),
                  human_time(times.steps.percentile(0.5)), human_time(times.steps.max()));
  if (run.budget_us) {
    sentence += fmt::format("; {} took longer than {:g} us, allowed {}", times.steps.over_limit(),
                            *run.budget_us, run.allowed);
  }
  page.conclusion = {failed ? Verdict::fail : Verdict::pass,
                     failed          ? "fail"
                     : run.budget_us ? "pass"
                                     : "measured",
                     fmt::format("Step times of {}", run.port), std::move(sentence)};
  page.facts = {{"attest", version},
                {"port", run.port},
                {"budget [us]", run.budget_us ? fmt::format("{:g}", *run.budget_us) : ""},
                {"time to read the clock, subtracted", human_time(times.clock)}};
  page.tables = {slowest_table(run), groups_table(run, groups)};
  page.groups = {distribution(run), by_rate(run)};
  return plot_page(page);
}

}  // namespace attest
