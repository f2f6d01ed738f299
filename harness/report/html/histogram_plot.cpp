#include "harness/report/html/histogram_plot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace attest {
namespace {

constexpr double bars_per_decade = 20;

int bar_of(const Histogram::Bucket& bucket, Nanoseconds unit) {
  const auto at_least_one = [](Nanoseconds time) {
    return static_cast<double>(std::max(time.count(), std::int64_t{1}));
  };
  const double middle = std::sqrt(at_least_one(bucket.from) * at_least_one(bucket.to)) /
                        static_cast<double>(unit.count());
  return static_cast<int>(std::floor(bars_per_decade * std::log10(middle)));
}

double edge(int bar) { return std::pow(10, bar / bars_per_decade); }

PlotSeries series_of(const NamedHistogram& histogram, int first, int last, Nanoseconds unit) {
  std::map<int, double> counts;
  double all = 0;
  for (const Histogram::Bucket& bucket : histogram.buckets) {
    counts[bar_of(bucket, unit)] += static_cast<double>(bucket.count);
    all += static_cast<double>(bucket.count);
  }
  PlotSeries series{histogram.name, {}, {}};
  for (int bar = first; bar <= last + 1; ++bar) {
    const auto found = counts.find(bar);
    series.x.push_back(edge(bar));
    series.y.push_back(found == counts.end() ? 0 : static_cast<float>(100 * found->second / all));
  }
  return series;
}

}  // namespace

Plot histogram_plot(std::string title, const std::vector<NamedHistogram>& histograms,
                    std::vector<PlotMark> marks, Nanoseconds unit) {
  Plot plot{std::move(title), "% of the samples"};
  plot.shape = PlotShape::bars;
  plot.logarithmic_x = plot.logarithmic_y = true;
  plot.marks = std::move(marks);
  int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
  for (const NamedHistogram& histogram : histograms) {
    for (const Histogram::Bucket& bucket : histogram.buckets) {
      first = std::min(first, bar_of(bucket, unit));
      last = std::max(last, bar_of(bucket, unit));
    }
  }
  if (first > last) return plot;
  // The plot extends to marks within two decades of the samples.
  constexpr int near = static_cast<int>(2 * bars_per_decade);
  const int from = first - near, to = last + near;
  for (const PlotMark& mark : plot.marks) {
    const int bar = static_cast<int>(std::floor(bars_per_decade * std::log10(mark.x)));
    if (bar < from || bar > to) continue;
    first = std::min(first, bar);
    last = std::max(last, bar);
  }
  for (std::size_t i = 0; i < histograms.size(); ++i) {
    if (histograms[i].buckets.empty()) continue;
    plot.series.push_back(series_of(histograms[i], first, last, unit));
    plot.series.back().colour = static_cast<int>(i);
  }
  return plot;
}

}  // namespace attest
