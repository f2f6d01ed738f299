// Plots of outputs in two traces: those that a port gave, and those that were wanted.
#pragma once

#include <cstddef>
#include <string>

#include "harness/compare/compare.hpp"
#include "harness/report/document.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

inline constexpr const char* sample_time = "time from the first sample [s]";

// One output, in each trace at the ticks that published it; a flag `published` at all ticks.
// `allowed`: a trace as allowed_deviations() makes it, whose values become a band around `want`;
// may be null. REQUIRES: `want` has a sample.
Plot plot_of_output(std::size_t channel, const Trace& want, const Trace& got,
                    const char* name_of_want, const Trace* allowed = nullptr);

// The float32 outputs that `want` has, of topics with a flag `published`.
PlotGroup plots_of_outputs(const Trace& want, const Trace& got, const char* name_of_want,
                           std::string caption = "Outputs");

// At the first deviation, at a tick of `want`.
PlotMark mark_of_first(const Deviation& first, const Trace& want);

}  // namespace attest
