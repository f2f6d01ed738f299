// The plots of a dispersed sweep. What is drawn does not grow with the number of samples.
#pragma once

#include <cstddef>
#include <vector>

#include "harness/report/html/plot_page.hpp"
#include "harness/sweep/summary.hpp"

namespace attest {

// A distribution with more than most_drawn_quantiles + 2 * drawn_tail values is drawn as quantiles,
// and each value of its tails is drawn.
inline constexpr std::size_t most_drawn_quantiles = 900;
inline constexpr std::size_t drawn_tail = 50;  // values at each end
// Of a scatter plot: a random choice of the samples, and the worst ones.
inline constexpr std::size_t most_drawn_samples = 1000;
// On the page: those of the pairs with the strongest rank correlation.
inline constexpr std::size_t most_scatter_plots = 48;

struct SweepPlots {
  std::vector<PlotGroup> groups;
  std::size_t scatter_plots = 0;  // without the limit; most_scatter_plots are drawn
};

// For each metric its cumulative distribution, and that of the difference between port and
// reference; then metrics over dispersions.
SweepPlots sweep_plots(const SweepFile& sweep, const SampleColumns& columns, const SampleData& data,
                       const SweepSummary& summary);

}  // namespace attest
