// Distributions of times as a plot.
#pragma once

#include <string>
#include <vector>

#include "harness/realtime/histogram.hpp"
#include "harness/report/html/plot_page.hpp"

namespace attest {

struct NamedHistogram {
  std::string name;
  std::vector<Histogram::Bucket> buckets;
};

double microseconds(Nanoseconds time);

// Bars of equal ratio, 20 for a factor of ten, over the time [us]: the share of the samples [%] of
// each histogram. Both axes are logarithmic, so that one slow sample of many is seen. Histograms
// without samples are left out; without any histogram the plot has no series.
Plot histogram_plot(std::string title, const std::vector<NamedHistogram>& histograms,
                    std::vector<PlotMark> marks);

}  // namespace attest
