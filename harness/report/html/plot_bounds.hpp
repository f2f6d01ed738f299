// The bounds of a metric as the area that they allow in a plot.
#pragma once

#include <vector>

#include "harness/report/document.hpp"

namespace attest {

struct DrawnBounds {
  float low, high;
};

// An infinite bound is drawn at the outermost value of the series, or at the other bound if that is
// farther out.
DrawnBounds drawn_bounds(double min, double max, const std::vector<PlotSeries>& series);

}  // namespace attest
