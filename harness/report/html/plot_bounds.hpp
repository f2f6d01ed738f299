// The bounds of a metric as the area that they allow in a plot.
#pragma once

#include <vector>

#include "harness/report/html/plot_page.hpp"

namespace attest {

struct DrawnBounds {
  float low, high;
};

// A bound that is infinite is drawn at the outermost value of the series.
DrawnBounds drawn_bounds(double min, double max, const std::vector<PlotSeries>& series);

}  // namespace attest
