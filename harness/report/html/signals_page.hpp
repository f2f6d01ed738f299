// Pages of signals over time: `attest plot`, `compare --html` and `replay --html`.
#pragma once

#include <string>
#include <vector>

#include "harness/compare/compare_signals.hpp"
#include "harness/ulog/flight_log.hpp"
#include "harness/verify/evaluate_log.hpp"

namespace attest {

// The signals `names` of all sources, a plot for each name. Times count from the first sample of
// all sources. REQUIRES: each name is in at least one source.
std::string signals_page(const std::vector<TimedSignals>& sources,
                         const std::vector<std::string>& names);

// The comparison of two sources by time. `shift_us` is that of compare_signals(); the page draws
// `got` earlier by this time. It plots the signals that deviate, at most most_plotted_signals, and
// their differences.
inline constexpr std::size_t most_plotted_signals = 24;
std::string comparison_page(const SignalsComparison& comparison, const TimedSignals& got,
                            const TimedSignals& want, std::int64_t shift_us);

// A port compared with a log: for each unit, the agreement of each topic, and a plot of each output
// of port and log. REQUIRES: a result for each unit.
std::string log_page(const FlightLog& log, const std::vector<LogResult>& results,
                     const LogLimits& limits, const std::string& port);

// A port compared with a trace: the first and the worst deviation, and a plot of each output of
// port and trace.
std::string trace_page(const Trace& want, const Trace& got, const VectorResult& result,
                       const std::string& port);

}  // namespace attest
