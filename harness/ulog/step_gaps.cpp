#include "harness/ulog/step_gaps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace attest {
namespace {

constexpr double us_per_s = 1e6, us_per_ms = 1e3;

// The slowest rates of PX4: IMU_GYRO_RATEMAX is at least 100 Hz, and the laws limit dt to 20 ms.
double slowest_hz(Module module) { return module == Module::rate_unit ? 100 : 50; }

// The median may exceed the period by this factor: a rate unit of 1 kHz may have samples 1.1 ms
// apart.
constexpr double slack = 1.25;

constexpr double most_missing = 0.01;

}  // namespace

double StepGaps::part_missing() const {
  const std::size_t all = steps + missing;
  return all == 0 ? 0 : static_cast<double>(missing) / static_cast<double>(all);
}

void GapCounts::add(std::uint64_t time_us) {
  if (steps_++ > 0) ++counts_[time_us - last_us_];
  last_us_ = time_us;
}

// A logger takes one step of several, so each gap is a multiple of the loop's period. Returns the
// period of which the gaps are nearest to multiples. An IMU gives only some rates, so a loop can be
// slower than its limit by up to half.
double GapCounts::period_us(double shortest_us) const {
  constexpr double slowest = 1.5, ratio = 1.0025;
  double best_us = 0, least = std::numeric_limits<double>::infinity();
  for (double period = shortest_us; period < slowest * shortest_us; period *= ratio) {
    double squares = 0;
    for (const auto& [gap, count] : counts_) {
      const double periods = static_cast<double>(gap) / period;
      const double off = periods - std::round(periods);
      squares += static_cast<double>(count) * off * off;
    }
    if (squares < least) best_us = period;
    least = std::min(least, squares);
  }
  return best_us;
}

StepGaps GapCounts::gaps(std::optional<double> fastest_hz) const {
  StepGaps found{steps_};
  if (counts_.empty()) return found;
  std::size_t up_to = 0;  // the number of gaps that are at most this long
  for (const auto& [gap, count] : counts_) {
    up_to += count;
    if (up_to <= (steps_ - 1) / 2) continue;
    found.median_us = static_cast<double>(gap);
    break;
  }
  for (const auto& [gap, count] : counts_) {
    // The limit prevents an overflow below: a damaged log may have any times.
    const double periods = std::min(std::round(static_cast<double>(gap) / found.median_us), 1e12);
    if (periods > 1) found.missing += count * (static_cast<std::size_t>(periods) - 1);
  }
  found.longest_us = counts_.rbegin()->first;
  if (fastest_hz) found.period_us = period_us(us_per_s / *fastest_hz);
  return found;
}

std::string too_sparse(Module module, const StepGaps& gaps, std::optional<double> fastest_hz) {
  const bool is_rate_unit = module == Module::rate_unit;
  const char* const sample = is_rate_unit ? "gyro sample" : "sample of the attitude";
  const char* const samples = is_rate_unit ? "gyro samples" : "samples of the attitude";
  const char* const memory = is_rate_unit ? "the integral and the yaw filter depend on every step"
                                          : "filters and slew rates depend on every step";
  const double median_ms = gaps.median_us / us_per_ms;
  if (gaps.steps < 2) {
    return fmt::format("the log has {} {}", gaps.steps, gaps.steps == 1 ? sample : samples);
  }
  if (gaps.median_us > slack * us_per_s / slowest_hz(module)) {
    const std::string rate = fastest_hz
                                 ? fmt::format("at up to {:g} Hz (IMU_GYRO_RATEMAX)", *fastest_hz)
                                 : fmt::format("at {:g} Hz or more", slowest_hz(module));
    return fmt::format("the log has a {} every {:.3g} ms, and the loop runs {}; {}", sample,
                       median_ms, rate, memory);
  }
  if (gaps.part_missing() <= most_missing) return "";
  return fmt::format(
      "the log lacks about {:.1f}% of the {}: usually they are {:.3g} ms apart, at most {:.3g} "
      "ms; {}",
      100 * gaps.part_missing(), samples, median_ms,
      static_cast<double>(gaps.longest_us) / us_per_ms, memory);
}

// A log with only every fourth step has equal intervals, so step_gaps() finds no missing step. The
// rate of a rate unit must therefore be known.
bool may_be_complete(Module module, const StepGaps& gaps, std::optional<double> fastest_hz) {
  if (gaps.missing > 0) return false;
  if (module != Module::rate_unit) return true;
  return fastest_hz && gaps.median_us <= slack * us_per_s / *fastest_hz;
}

}  // namespace attest
