// Distributions of times as a plot.
#pragma once

#include <string>
#include <vector>

#include "harness/core/histogram.hpp"
#include "harness/report/document.hpp"

namespace attest {

struct NamedHistogram {
  std::string name;
  std::vector<Histogram::Bucket> buckets;
};

// The share of the samples [%] of each histogram, as bars over the time [us]. A factor of ten has
// 20 bars of equal width on the logarithmic axis. Both axes are logarithmic, so that a single slow
// sample among many is visible. Histograms without samples are left out; without any histogram the
// plot has no series. `unit`: of the axis and of the marks, in the times of the histograms.
Plot histogram_plot(std::string title, const std::vector<NamedHistogram>& histograms,
                    std::vector<PlotMark> marks, Nanoseconds unit = std::chrono::microseconds(1));

}  // namespace attest
