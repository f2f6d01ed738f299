#include "harness/compare/compare_signals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "harness/core/agreement.hpp"

namespace attest {
namespace {

constexpr std::int64_t most_periods = 250;
constexpr double least_gain = 10;
constexpr std::size_t least_overlap = 16;  // samples; fewer samples may agree by chance

Tolerance tolerance_of(const std::string& name, const Tolerances& tolerances, double others) {
  const ChannelSet outputs = channels_named("out/" + name);
  return outputs.any() ? tolerances.of(outputs._Find_first()) : Tolerance{others, 0};
}

bool is_within(float got, float want, const Tolerance& tolerance, bool by_bits) {
  return by_bits ? same_bits(got, want) : agree(got, want, tolerance.at(want));
}

double distance(const SignalPair& pair) { return attest::distance(pair.got, pair.want); }

std::int64_t moved(std::uint64_t time_us, std::int64_t shift_us) {
  return static_cast<std::int64_t>(time_us) - shift_us;
}

// Calls `pair(i, j)` for samples at equal times, and counts the others.
template <typename Pair>
void align(const TimedSignal& got, const TimedSignal& want, std::int64_t shift_us,
           std::size_t& only_got, std::size_t& only_want, Pair pair) {
  std::size_t i = 0, j = 0;
  while (i < got.times_us.size() && j < want.times_us.size()) {
    const std::int64_t at = moved(got.times_us[i], shift_us);
    const auto other = static_cast<std::int64_t>(want.times_us[j]);
    if (at == other)
      pair(i++, j++);
    else if (at < other)
      ++i, ++only_got;
    else
      ++j, ++only_want;
  }
  only_got += got.times_us.size() - i;
  only_want += want.times_us.size() - j;
}

SignalComparison compare_signal(const TimedSignal& got, const TimedSignal& want,
                                const Tolerance& tolerance, bool by_bits, std::int64_t shift_us) {
  SignalComparison found;
  found.name = want.name;
  found.tolerance = tolerance;
  align(got, want, shift_us, found.only_got, found.only_want, [&](std::size_t i, std::size_t j) {
    ++found.compared;
    if (is_within(got.values[i], want.values[j], tolerance, by_bits)) return;
    ++found.deviating;
    const SignalPair pair{want.times_us[j], got.values[i], want.values[j]};
    if (!found.first) found.first = pair;
    if (!found.worst || distance(pair) > distance(*found.worst)) found.worst = pair;
  });
  return found;
}

// The root mean square of the differences at equal times; empty if there are too few of them.
std::optional<double> rms_difference(const TimedSignal& got, const TimedSignal& want,
                                     std::int64_t shift_us) {
  std::size_t ignored = 0, count = 0;
  double sum = 0;
  align(got, want, shift_us, ignored, ignored, [&](std::size_t i, std::size_t j) {
    const double off = static_cast<double>(got.values[i]) - static_cast<double>(want.values[j]);
    if (!std::isfinite(off)) return;
    sum += off * off;
    ++count;
  });
  if (count < std::max(least_overlap, want.values.size() / 2)) return std::nullopt;
  return std::sqrt(sum / static_cast<double>(count));
}

std::int64_t period_of(const TimedSignal& signal) {
  std::vector<std::int64_t> gaps;
  for (std::size_t i = 1; i < signal.times_us.size(); ++i) {
    gaps.push_back(static_cast<std::int64_t>(signal.times_us[i] - signal.times_us[i - 1]));
  }
  if (gaps.empty()) return 0;
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  return *middle;
}

// The pair of signals with the most samples that differ; null if no sample differs.
std::pair<const TimedSignal*, const TimedSignal*> most_different(const TimedSignals& got,
                                                                 const TimedSignals& want) {
  std::pair<const TimedSignal*, const TimedSignal*> found{};
  std::size_t most = 0;
  for (const TimedSignal& one : want.all) {
    const TimedSignal* const other = got.find(one.name);
    if (other == nullptr) continue;
    const std::size_t deviating = compare_signal(*other, one, {}, false, 0).deviating;
    if (deviating <= most) continue;
    most = deviating;
    found = {other, &one};
  }
  return found;
}

}  // namespace

std::size_t SignalsComparison::compared() const {
  std::size_t count = 0;
  for (const SignalComparison& signal : signals) count += signal.compared;
  return count;
}

std::size_t SignalsComparison::deviating_signals() const {
  return static_cast<std::size_t>(std::count_if(
      signals.begin(), signals.end(), [](const SignalComparison& s) { return !s.agrees(); }));
}

std::optional<TimeShift> estimate_shift(const TimedSignals& got, const TimedSignals& want) {
  const auto [of_got, of_want] = most_different(got, want);
  if (of_got == nullptr) return std::nullopt;
  const auto unshifted = rms_difference(*of_got, *of_want, 0);
  const std::int64_t period = period_of(*of_want);
  if (!unshifted || period == 0 || period > latest_us / most_periods) return std::nullopt;
  TimeShift best{0, of_want->name, *unshifted, *unshifted};
  for (std::int64_t periods = -most_periods; periods <= most_periods; ++periods) {
    const auto rms = rms_difference(*of_got, *of_want, periods * period);
    if (rms && *rms < best.rms) best = {periods * period, of_want->name, *rms, *unshifted};
  }
  if (best.us == 0 || best.rms * least_gain > best.rms_unshifted) return std::nullopt;
  return best;
}

SignalsComparison compare_signals(const TimedSignals& got, const TimedSignals& want,
                                  const Tolerances& tolerances, double others,
                                  std::int64_t shift_us) {
  SignalsComparison found;
  for (const TimedSignal& signal : got.all) {
    if (want.find(signal.name) == nullptr) found.only_in_got.push_back(signal.name);
  }
  for (const TimedSignal& signal : want.all) {
    const TimedSignal* const other = got.find(signal.name);
    if (other == nullptr) {
      found.only_in_want.push_back(signal.name);
    } else {
      const Tolerance tolerance = tolerance_of(signal.name, tolerances, others);
      const bool by_bits = tolerances.level() == Level::exact && tolerance.absolute == 0;
      found.signals.push_back(compare_signal(*other, signal, tolerance, by_bits, shift_us));
    }
  }
  if (!found.agrees() && shift_us == 0) found.shift = estimate_shift(got, want);
  return found;
}

}  // namespace attest
