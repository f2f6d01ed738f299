#include "harness/loop/angular_acceleration.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace attest {

AngularAcceleration::AngularAcceleration(const Rate& sampling, double cutoff_hz)
    : low_pass_(biquad(sampling, cutoff_hz)) {}

std::optional<AngularAcceleration::Biquad> AngularAcceleration::biquad(const Rate& sampling,
                                                                       double cutoff_hz) {
  const bool exists = cutoff_hz > 0 && cutoff_hz < sampling.hertz() / 2;
  if (!exists) return std::nullopt;
  // The last bit of tan() depends on the C library. Rounded to float32 it is the same everywhere.
  // This changes the cutoff by less than 1e-6 of its value.
  const double tangent = std::tan(std::numbers::pi * cutoff_hz * sampling.period_s());
  const double k = static_cast<double>(static_cast<float>(tangent));
  const double a0 = 1 + std::numbers::sqrt2 * k + k * k;
  return Biquad{k * k / a0, 2 * (k * k - 1) / a0, (1 - std::numbers::sqrt2 * k + k * k) / a0};
}

const Vector3& AngularAcceleration::sample(Nanoseconds now, const Vector3& rate_rad_s) {
  if (last_ && now <= *last_) return acceleration_rad_s2_;
  if (last_) {
    const double dt_s = in_seconds(now - *last_);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      acceleration_rad_s2_[axis] =
          filtered(axis, (rate_rad_s[axis] - last_rate_rad_s_[axis]) / dt_s);
    }
  }
  last_ = now;
  last_rate_rad_s_ = rate_rad_s;
  return acceleration_rad_s2_;
}

double AngularAcceleration::filtered(std::size_t axis, double difference_rad_s2) {
  if (!low_pass_) return difference_rad_s2;
  const auto [b, a1, a2] = *low_pass_;
  const double result = b * difference_rad_s2 + delay_1_[axis];
  delay_1_[axis] = 2 * b * difference_rad_s2 - a1 * result + delay_2_[axis];
  delay_2_[axis] = b * difference_rad_s2 - a2 * result;
  return result;
}

}  // namespace attest
