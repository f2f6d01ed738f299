#include "harness/loop/gyro_filter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace attest {
namespace {

// The firmware limits the time between two samples to these bounds.
constexpr double dt_min_s = 20e-6, dt_max_s = 0.02;

bool can_filter(const Rate& sampling, double cutoff_hz) {
  return cutoff_hz > 0 && cutoff_hz < sampling.hertz() / 2;
}

double weight_of(const Rate& sampling, double cutoff_hz) {
  if (!can_filter(sampling, cutoff_hz)) return 1;
  const double time_constant_s = 1 / (2 * std::numbers::pi * cutoff_hz);
  return sampling.period_s() / (time_constant_s + sampling.period_s());
}

}  // namespace

GyroFilter::GyroFilter(const Rate& sampling, double rate_cutoff_hz, double acceleration_cutoff_hz)
    : rate_low_pass_(biquad(sampling, rate_cutoff_hz)),
      acceleration_weight_(weight_of(sampling, acceleration_cutoff_hz)) {}

std::optional<GyroFilter::Biquad> GyroFilter::biquad(const Rate& sampling, double cutoff_hz) {
  if (!can_filter(sampling, cutoff_hz)) return std::nullopt;
  // The last bit of tan() depends on the C library. Rounded to float32 it is the same everywhere.
  // This changes the cutoff by less than 1e-6 of its value.
  const double tangent = std::tan(std::numbers::pi * cutoff_hz * sampling.period_s());
  const double k = static_cast<double>(static_cast<float>(tangent));
  const double a0 = 1 + std::numbers::sqrt2 * k + k * k;
  return Biquad{k * k / a0, 2 * (k * k - 1) / a0, (1 - std::numbers::sqrt2 * k + k * k) / a0};
}

void GyroFilter::sample(Nanoseconds now, const Vector3& rate_rad_s) {
  if (last_ && now <= *last_) return;
  if (!last_) {
    first_rad_s_ = rate_rad_s_ = rate_rad_s;
    last_ = now;
    return;
  }
  const double dt_s = std::clamp(in_seconds(now - *last_), dt_min_s, dt_max_s);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double filtered = first_rad_s_[axis] + low_passed(axis, rate_rad_s[axis]);
    const double derivative = (filtered - rate_rad_s_[axis]) / dt_s;
    rate_rad_s_[axis] = filtered;
    acceleration_rad_s2_[axis] += acceleration_weight_ * (derivative - acceleration_rad_s2_[axis]);
  }
  last_ = now;
}

// The change of the rate since the first sample, after the low-pass.
double GyroFilter::low_passed(std::size_t axis, double rate_rad_s) {
  const double change = rate_rad_s - first_rad_s_[axis];
  if (!rate_low_pass_) return change;
  const auto [b, a1, a2] = *rate_low_pass_;
  const double result = b * change + delay_1_[axis];
  delay_1_[axis] = 2 * b * change - a1 * result + delay_2_[axis];
  delay_2_[axis] = b * change - a2 * result;
  return result;
}

}  // namespace attest
