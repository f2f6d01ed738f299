// Compares two traces or logs of any origin, sample by sample at equal times.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/compare/timed_signals.hpp"
#include "harness/compare/tolerance.hpp"

namespace attest {

struct SignalPair {
  std::uint64_t time_us;  // of `want`
  float got, want;
};

// One signal that both have.
struct SignalComparison {
  std::string name;
  Tolerance tolerance;  // that was applied
  std::size_t compared = 0, deviating = 0;
  std::size_t only_got = 0, only_want = 0;  // samples without one of the other at the same time
  std::optional<SignalPair> first, worst;   // of those that deviate

  // False without samples at equal times: then it is unknown whether the signals agree.
  bool agrees() const { return compared > 0 && deviating == 0; }
};

// `got` lags by this time: a sample of `got` at t has the value that `want` has at t - us.
struct TimeShift {
  std::int64_t us = 0;
  std::string signal;                 // the shift was estimated from this signal
  double rms = 0, rms_unshifted = 0;  // differences of that signal, root mean square
};

struct SignalsComparison {
  std::vector<SignalComparison> signals;  // that both have, by name
  std::vector<std::string> only_in_got, only_in_want;
  // Estimated only if the signals do not agree and `shift_us` was 0. Empty if no shift explains the
  // differences.
  std::optional<TimeShift> shift;

  std::size_t compared() const;  // samples
  std::size_t deviating_signals() const;
  bool agrees() const { return compared() > 0 && deviating_signals() == 0; }
};

// The signals of `got` are moved earlier by `shift_us` before they are compared. A signal with the
// name of an output of a module has the tolerance of `tolerances`; any other signal has the
// absolute tolerance `others`. Any NaN equals any NaN; NaN and infinity differ from every number.
// At the exact level, a signal with tolerance 0 must have equal bits, so -0 differs from 0.
// REQUIRES: `shift_us` between -latest_us and latest_us.
SignalsComparison compare_signals(const TimedSignals& got, const TimedSignals& want,
                                  const Tolerances& tolerances, double others,
                                  std::int64_t shift_us = 0);

// Estimates by how much `got` lags: the shift with the least mean square difference (the average
// square difference function of delay estimation) among whole multiples of the sample period, up to
// 250 of them in either direction. It is estimated from the signal with the most samples that
// differ. Empty if the shift does not make the root mean square difference at least ten times
// smaller, as for noise, a constant, or equal signals.
std::optional<TimeShift> estimate_shift(const TimedSignals& got, const TimedSignals& want);

}  // namespace attest
