// The plots of a dispersed sweep. The number of points does not grow with the number of samples.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "harness/report/document.hpp"
#include "harness/sweep/summary.hpp"

namespace attest {

// A distribution with more than most_drawn_quantiles + 2 * drawn_tail values is drawn at
// most_drawn_quantiles quantiles, and at each value of its tails.
inline constexpr std::size_t most_drawn_quantiles = 900;
inline constexpr std::size_t drawn_tail = 50;  // number of values at each end
// A scatter plot draws at most so many samples, chosen at random, and the worst samples in
// addition.
inline constexpr std::size_t most_drawn_samples = 1000;
// The page has at most so many scatter plots, for the pairs with the strongest rank correlation.
inline constexpr std::size_t most_scatter_plots = 48;

struct SweepPlots {
  std::vector<PlotGroup> groups;
  std::size_t scatter_plots = 0;  // number of pairs; at most most_scatter_plots are drawn
};

using UnitsOfMetrics = std::map<std::string, std::string>;  // by the names of the metrics

// For each metric its cumulative distribution and, with a port, that of the difference between port
// and reference; then metrics over dispersions.
SweepPlots sweep_plots(const SweepFile& sweep, const SampleColumns& columns, const SampleData& data,
                       const SweepSummary& summary, const UnitsOfMetrics& units = {});

}  // namespace attest
