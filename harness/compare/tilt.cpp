#include "harness/compare/tilt.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace attest {
namespace {

using Vector = std::array<double, 3>;

// Third column of R(q), unit length for any q but zero.
Vector thrust_axis(const float (&q)[4]) {
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  const double norm = w * w + x * x + y * y + z * z;
  return {2 * (w * y + x * z) / norm, 2 * (y * z - w * x) / norm,
          (w * w - x * x - y * y + z * z) / norm};
}

}  // namespace

double tilt_error(const attest_inputs& state, const attest_inputs& setpoint) {
  const Vector a = thrust_axis(state.control_state.q);
  const Vector b = thrust_axis(setpoint.vehicle_attitude_setpoint.q_d);
  const double sine =
      std::hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
  return std::atan2(sine, a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

void AttitudeGain::set(const ParameterChange& change) {
  const auto& [when, name, value] = change;
  if (name == "MC_ROLL_P") roll_p_ = value;
  if (name == "MC_ROLL_TC") roll_tc_ = value;
  if (name == "MC_PITCH_P") pitch_p_ = value;
  if (name == "MC_PITCH_TC") pitch_tc_ = value;
}

double AttitudeGain::value() const {
  return std::max(std::abs(roll_p_ * 0.2 / roll_tc_), std::abs(pitch_p_ * 0.2 / pitch_tc_));
}

}  // namespace attest
