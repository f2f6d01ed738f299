#include "harness/compare/tilt.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace attest {
namespace {

using Vector = std::array<double, 3>;

// Third column of R(q), unit length for any q but zero.
Vector thrust_axis(const AttitudeQuaternion& q) {
  const auto& [w, x, y, z] = q;
  const double norm = w * w + x * x + y * y + z * z;
  return {2 * (w * y + x * z) / norm, 2 * (y * z - w * x) / norm,
          (w * w - x * x - y * y + z * z) / norm};
}

}  // namespace

double tilt_error(const AttitudeQuaternion& q, const AttitudeQuaternion& q_d) {
  const Vector a = thrust_axis(q);
  const Vector b = thrust_axis(q_d);
  const double sine =
      std::hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
  return std::atan2(sine, a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

double attitude_error(const AttitudeQuaternion& q, const AttitudeQuaternion& q_d) {
  const auto& [w, x, y, z] = q;
  const auto& [wd, xd, yd, zd] = q_d;
  const double cosine = std::abs(w * wd + x * xd + y * yd + z * zd);
  const double sine = std::hypot(w * xd - x * wd - y * zd + z * yd,  // of half the angle
                                 w * yd - y * wd - z * xd + x * zd,  //
                                 w * zd - z * wd - x * yd + y * xd);
  if ((cosine == 0 && sine == 0) || !std::isfinite(cosine) || !std::isfinite(sine))
    return std::nan("");
  return 2 * std::atan2(sine, cosine);
}

AttitudeGain::AttitudeGain(Module module) : module_(module) {}

void AttitudeGain::set(const ParameterChange& change) {
  const auto& [when, name, value] = change;
  if (name == "MC_ROLL_P") roll_p_ = value;
  if (name == "MC_ROLL_TC") roll_tc_ = value;
  if (name == "MC_PITCH_P") pitch_p_ = value;
  if (name == "MC_PITCH_TC") pitch_tc_ = value;
  if (name == "MC_YAW_P") yaw_p_ = value;
  if (name == "MC_YAW_WEIGHT") yaw_weight_ = value;
}

double AttitudeGain::value() const {
  if (module_ == Module::mc_att_control) {
    return std::max(std::abs(roll_p_ * 0.2 / roll_tc_), std::abs(pitch_p_ * 0.2 / pitch_tc_));
  }
  const double weight = std::clamp(yaw_weight_, 0.0, 1.0);
  const double yaw = weight > 1e-4 ? yaw_p_ / weight : yaw_p_;
  return std::max({std::abs(roll_p_), std::abs(pitch_p_), std::abs(yaw)});
}

}  // namespace attest
