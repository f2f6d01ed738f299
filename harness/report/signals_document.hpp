// The reports of `attest plot` and `attest compare --by-time`.
#pragma once

#include <string>
#include <vector>

#include "harness/compare/compare_signals.hpp"
#include "harness/report/document.hpp"

namespace attest {

// The signals `names` of all sources, a plot for each name. Times count from the first sample of
// all sources. REQUIRES: each name is in at least one source.
Document signals_document(const std::vector<TimedSignals>& sources,
                          const std::vector<std::string>& names);

// The comparison of two sources by time. `shift_us` is that of compare_signals(); the plots draw
// `got` earlier by this time. It plots the signals that deviate, at most most_plotted_signals, and
// their differences.
inline constexpr std::size_t most_plotted_signals = 24;
Document comparison_document(const SignalsComparison& comparison, const TimedSignals& got,
                             const TimedSignals& want, std::int64_t shift_us);

}  // namespace attest
