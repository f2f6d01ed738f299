#include "harness/report/signals_text.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/report/text.hpp"

namespace attest {
namespace {

std::string tolerance_text(const Tolerance& tolerance) {
  if (tolerance.relative == 0) return fmt::format("{:g}", tolerance.absolute);
  return fmt::format("{:g} or {:g} of the value", tolerance.absolute, tolerance.relative);
}

std::string pair_text(const char* which, const SignalPair& pair) {
  return fmt::format("    {} at {} us: got {}, want {}\n", which, pair.time_us, pair.got,
                     pair.want);
}

std::string deviating_text(const SignalComparison& signal) {
  if (signal.compared == 0) {
    return fmt::format("  {}: no timestamp in common, so no sample was compared\n", signal.name);
  }
  return fmt::format("  {}: {} of {} samples deviate by more than {}\n", signal.name,
                     signal.deviating, signal.compared, tolerance_text(signal.tolerance)) +
         pair_text("first", *signal.first) + pair_text("worst", *signal.worst);
}

// "  only in A: 3 signals: a, b, c".
std::string missing_text(const char* where, const std::vector<std::string>& names) {
  constexpr std::size_t most = 8;
  if (names.empty()) return "";
  const auto end = names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), most));
  return fmt::format("  only in {}: {}: {}{}\n", where, counted(names.size(), "signal"),
                     fmt::join(names.begin(), end, ", "), names.size() > most ? ", ..." : "");
}

std::string shift_text(const TimeShift& shift) {
  return fmt::format(
      "  the first {} the second by {} us, estimated from {}\n"
      "    with this shift (--shift {}) its difference is {:.3g} instead of {:.3g} (rms)\n",
      shift.us > 0 ? "lags behind" : "is ahead of", std::abs(shift.us), shift.signal, shift.us,
      shift.rms, shift.rms_unshifted);
}

}  // namespace

std::string signals_text(const SignalsComparison& comparison) {
  std::string text;
  std::size_t only_got = 0, only_want = 0;
  for (const SignalComparison& signal : comparison.signals) {
    if (!signal.agrees()) text += deviating_text(signal);
    only_got += signal.only_got;
    only_want += signal.only_want;
  }
  if (only_got + only_want > 0) {
    text += fmt::format(
        "  samples at times that the other does not have: {} in the first, {} in "
        "the second\n",
        only_got, only_want);
  }
  text += missing_text("the first", comparison.only_in_got);
  text += missing_text("the second", comparison.only_in_want);
  if (comparison.shift) text += shift_text(*comparison.shift);
  return text;
}

}  // namespace attest
