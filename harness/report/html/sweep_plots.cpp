#include "harness/report/html/sweep_plots.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "harness/sweep/parse_dispersions.hpp"

namespace attest {
namespace {

constexpr float not_drawn = std::numeric_limits<float>::quiet_NaN();
constexpr int colour_of_worst = 2;

// The indices in `count` sorted values at which a distribution is drawn.
std::vector<std::size_t> drawn_ranks(std::size_t count) {
  std::vector<std::size_t> ranks;
  const std::size_t middle = most_drawn_quantiles;
  if (count <= middle + 2 * drawn_tail) {
    ranks.resize(count);
    std::iota(ranks.begin(), ranks.end(), std::size_t{0});
    return ranks;
  }
  for (std::size_t i = 0; i < drawn_tail; ++i) ranks.push_back(i);
  for (std::size_t i = 0; i < middle; ++i) {
    ranks.push_back(drawn_tail + i * (count - 2 * drawn_tail) / middle);
  }
  for (std::size_t i = drawn_tail; i-- > 0;) ranks.push_back(count - 1 - i);
  return ranks;
}

// The share of `flights` [%] with at most the value x. Empty: no value is finite.
PlotSeries cumulative(std::string name, const std::vector<double>& values, std::size_t flights) {
  PlotSeries series{std::move(name), {}, {}};
  std::vector<double> sorted;
  std::copy_if(values.begin(), values.end(), std::back_inserter(sorted),
               [](double value) { return std::isfinite(value); });
  std::sort(sorted.begin(), sorted.end());
  for (const std::size_t rank : drawn_ranks(sorted.size())) {
    const double value = sorted[rank];
    if (!series.x.empty() && series.x.back() == value) continue;
    const auto above = std::upper_bound(sorted.begin(), sorted.end(), value);
    series.x.push_back(value);
    series.y.push_back(static_cast<float>(100 * static_cast<double>(above - sorted.begin()) /
                                          static_cast<double>(flights)));
  }
  return series;
}

// The distance from the values up to which a bound is drawn. A bound farther away would compress
// the values in the plot.
double reach_of(double first, double last) {
  constexpr double widths = 4;
  return widths * (last > first ? last - first : std::max(std::abs(last), 1e-9));
}

// Extends a distribution on the left with the share 0, and on both sides to the marks within
// reach_of(). Returns the texts of the other marks.
std::string extend(const std::vector<PlotMark>& marks, PlotSeries& series) {
  const double first = series.x.front(), last = series.x.back();
  const double reach = reach_of(first, last);
  double from = first - 0.005 * reach, to = last;
  std::string far;
  for (const PlotMark& mark : marks) {
    if (mark.x < first - reach || mark.x > last + reach) {
      far += fmt::format("Outside of the plot: {}, {:g}. ", mark.text, mark.x);
      continue;
    }
    from = std::min(from, mark.x);
    to = std::max(to, mark.x);
  }
  series.x.insert(series.x.begin(), from);
  series.y.insert(series.y.begin(), 0);
  if (to == last) return far;
  series.x.push_back(to);
  series.y.push_back(series.y.back());
  return far;
}

std::vector<PlotMark> bounds_of(const std::string& metric, const SweepFile& sweep) {
  std::vector<PlotMark> marks;
  for (const Requirement& one : sweep.requirements) {
    if (one.metric != metric) continue;
    if (std::isfinite(one.min)) marks.push_back({one.min, one.name + ", min"});
    if (std::isfinite(one.max)) marks.push_back({one.max, one.name + ", max"});
  }
  return marks;
}

std::string note_on_missing(const std::string& pilot, const std::vector<double>& values) {
  const auto missing = std::count_if(values.begin(), values.end(),
                                     [](double value) { return !std::isfinite(value); });
  if (missing == 0) return "";
  return fmt::format("{} of the {} flights of the {} have no finite value. ", missing,
                     values.size(), pilot);
}

Plot distribution_of(const SweepFile& sweep, const SampleColumns& columns, const SampleData& data,
                     std::size_t metric) {
  Plot plot{columns.metrics[metric], "% of all flights with at most this value"};
  plot.shape = PlotShape::steps;
  plot.marks = bounds_of(columns.metrics[metric], sweep);
  for (std::size_t pilot = 0; pilot < data.pilots.size(); ++pilot) {
    const std::string name = pilot == 0 ? "reference" : "port";
    const std::vector<double>& values = data.pilots[pilot].metrics[metric];
    plot.note += note_on_missing(name, values);
    PlotSeries series = cumulative(name, values, data.samples());
    if (series.x.empty()) continue;
    const std::string far = extend(plot.marks, series);
    if (plot.series.empty()) plot.note += far;
    series.colour = static_cast<int>(pilot);
    plot.series.push_back(std::move(series));
  }
  return plot;
}

Plot difference_of(const SampleColumns& columns, const SampleData& data, std::size_t metric) {
  const std::vector<double>& reference = data.pilots.front().metrics[metric];
  const std::vector<double>& port = data.pilots.back().metrics[metric];
  std::vector<double> differences;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    if (std::isfinite(reference[i]) && std::isfinite(port[i])) {
      differences.push_back(port[i] - reference[i]);
    }
  }
  Plot plot{fmt::format("{}: port minus reference, on the same sample", columns.metrics[metric]),
            "% of the samples with at most this difference"};
  plot.shape = PlotShape::steps;
  plot.marks = {{0, "equal"}};
  PlotSeries series = cumulative("difference", differences, differences.size());
  if (series.x.empty()) return plot;
  extend(plot.marks, series);
  plot.series.push_back(std::move(series));
  return plot;
}

std::string unit_of(const std::string& metric, const UnitsOfMetrics& units) {
  const auto found = units.find(metric);
  return found == units.end() ? "" : found->second;
}

// Each plot is a group of its own, because each plot has another quantity on the x axis.
void add_distributions(const SweepFile& sweep, const SampleColumns& columns, const SampleData& data,
                       const UnitsOfMetrics& units, std::vector<PlotGroup>& groups) {
  const std::size_t first = groups.size();
  for (std::size_t metric = 0; metric < columns.metrics.size(); ++metric) {
    Plot plot = distribution_of(sweep, columns, data, metric);
    if (plot.series.empty()) continue;
    const std::string& name = columns.metrics[metric];
    const std::string unit = unit_of(name, units);
    const std::string label = unit.empty() ? name : fmt::format("{} [{}]", name, unit);
    groups.push_back({"", label, {std::move(plot)}});
    if (!columns.with_port) continue;
    Plot difference = difference_of(columns, data, metric);
    if (difference.series.empty()) continue;
    groups.push_back({"", "difference of " + label, {std::move(difference)}});
  }
  if (groups.size() > first) groups[first].title = "Distributions";
}

struct Pair {
  std::size_t dispersion = 0, metric = 0;
  double strength = 0;  // of the rank correlation
};

std::vector<Pair> pairs_of(const SweepFile& sweep, const SweepSummary& summary) {
  std::vector<Pair> pairs;
  for (const std::size_t dispersion : dimensions_of(sweep.dispersions)) {
    for (std::size_t metric = 0; metric < summary.metrics.size(); ++metric) {
      const double correlation = summary.metrics[metric].correlation[dispersion];
      pairs.push_back({dispersion, metric, std::isnan(correlation) ? 0 : std::abs(correlation)});
    }
  }
  return pairs;
}

// The pairs with the strongest correlation, in the order of the sweep file.
std::vector<Pair> strongest(std::vector<Pair> pairs) {
  if (pairs.size() <= most_scatter_plots) return pairs;
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Pair& a, const Pair& b) { return a.strength > b.strength; });
  pairs.resize(most_scatter_plots);
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return std::pair(a.dispersion, a.metric) < std::pair(b.dispersion, b.metric);
  });
  return pairs;
}

std::set<std::uint64_t> worst_of(const SweepSummary& summary) {
  std::set<std::uint64_t> worst;
  for (const RequirementResult& one : summary.requirements) {
    worst.insert(one.worst.begin(), one.worst.end());
  }
  return worst;
}

// A permutation chooses the samples, because a regular step could coincide with the levels of a
// grid.
std::set<std::uint64_t> drawn_samples(std::uint64_t samples, const std::set<std::uint64_t>& worst) {
  const SampleStream stream("the samples that a page draws");
  std::set<std::uint64_t> drawn = worst;
  const std::uint64_t count = std::min<std::uint64_t>(samples, most_drawn_samples);
  for (std::uint64_t i = 0; i < count; ++i) {
    drawn.insert(count == samples ? i : permuted(i, samples, 0, stream));
  }
  return drawn;
}

// Draws the bounds of the first requirement on the metric. A bound beyond reach_of() counts as
// infinite.
void add_band(const std::string& metric, const SweepFile& sweep, Plot& plot) {
  const auto& all = sweep.requirements;
  const auto one = std::find_if(all.begin(), all.end(),
                                [&](const Requirement& each) { return each.metric == metric; });
  if (one == all.end()) return;
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const auto [first, last] = drawn_bounds(-infinite, infinite, plot.series);
  const double reach = reach_of(first, last);
  const auto [low, high] = drawn_bounds(one->min < first - reach ? -infinite : one->min,
                                        one->max > last + reach ? infinite : one->max, plot.series);
  const std::vector<double>& x = plot.series.front().x;
  plot.band = PlotBand{"within the bounds of " + one->name, x, std::vector(x.size(), low),
                       std::vector(x.size(), high)};
}

// Both series have the same x. With different x, plots.js would merge samples with equal x.
Plot scatter_of(const Pair& pair, const SweepFile& sweep, const SampleColumns& columns,
                const SampleData& data, const std::set<std::uint64_t>& drawn,
                const std::set<std::uint64_t>& worst, const UnitsOfMetrics& units) {
  const std::vector<double>& numbers = data.drawn[pair.dispersion];
  const std::vector<double>& values = data.pilots.back().metrics[pair.metric];
  std::vector<std::uint64_t> order(drawn.begin(), drawn.end());
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint64_t a, std::uint64_t b) { return numbers[a] < numbers[b]; });
  PlotSeries flights{"flights", {}, {}}, marked{"worst flights", {}, {}};
  marked.colour = colour_of_worst;
  for (const std::uint64_t i : order) {
    const bool is_worst = worst.contains(i);
    const float value = std::isfinite(values[i]) ? static_cast<float>(values[i]) : not_drawn;
    flights.x.push_back(numbers[i]);
    flights.y.push_back(is_worst ? not_drawn : value);
    marked.y.push_back(is_worst ? value : not_drawn);
  }
  marked.x = flights.x;
  Plot plot{
      fmt::format("{} over {}", columns.metrics[pair.metric], columns.dispersions[pair.dispersion]),
      unit_of(columns.metrics[pair.metric], units)};
  plot.shape = PlotShape::scatter;
  plot.series.push_back(std::move(flights));
  if (!worst.empty()) plot.series.push_back(std::move(marked));
  add_band(columns.metrics[pair.metric], sweep, plot);
  return plot;
}

}  // namespace

SweepPlots sweep_plots(const SweepFile& sweep, const SampleColumns& columns,
                       const SampleData& samples, const SweepSummary& summary,
                       const UnitsOfMetrics& units) {
  SweepPlots plots;
  add_distributions(sweep, columns, samples, units, plots.groups);
  const std::vector<Pair> pairs = pairs_of(sweep, summary);
  plots.scatter_plots = pairs.size();
  const std::set<std::uint64_t> worst = worst_of(summary);
  const std::set<std::uint64_t> drawn = drawn_samples(samples.samples(), worst);
  const std::string* last = nullptr;
  for (const Pair& pair : strongest(pairs)) {
    const std::string& name = columns.dispersions[pair.dispersion];
    if (last != &name) {
      plots.groups.push_back({last == nullptr ? "Metrics over dispersions" : "", name, {}});
    }
    last = &name;
    plots.groups.back().plots.push_back(
        scatter_of(pair, sweep, columns, samples, drawn, worst, units));
  }
  return plots;
}

}  // namespace attest
