#include "harness/report/html/plot_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace attest {

DrawnBounds drawn_bounds(double min, double max, const std::vector<PlotSeries>& series) {
  double lowest = std::numeric_limits<double>::max(), highest = -lowest;
  for (const PlotSeries& one : series) {
    for (const float y : one.y) {
      if (!std::isfinite(y)) continue;
      lowest = std::min(lowest, static_cast<double>(y));
      highest = std::max(highest, static_cast<double>(y));
    }
  }
  const double low = std::isinf(min) ? std::min(lowest, max) : min;
  const double high = std::isinf(max) ? std::max(highest, low) : max;
  return {static_cast<float>(low), static_cast<float>(high)};
}

}  // namespace attest
