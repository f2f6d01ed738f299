// The comparison of two traces by their timestamps, for the terminal.
#pragma once

#include <string>

#include "harness/compare/compare_signals.hpp"

namespace attest {

// Several lines, with a newline at the end: a row for each signal that deviates, the signals and
// samples that only one trace has, and the time by which one trace lags.
std::string signals_text(const SignalsComparison& comparison);

}  // namespace attest
