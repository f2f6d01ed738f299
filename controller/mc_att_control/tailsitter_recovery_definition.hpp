// The definitions of RecoveryStages, for code that instantiates it with another scalar type.
#pragma once

#include <algorithm>
#include <cmath>

#include "controller/elementary/elementary.hpp"
#include "controller/mc_att_control/tailsitter_recovery.hpp"

namespace attest::mc_att_control {
namespace recovery {

template <typename Scalar>
constexpr Scalar pi = Scalar(3.14159265358979323846);

template <typename Scalar>
constexpr Scalar half_pi = Scalar(1.57079632679489661923);

// A value times the logistic function of v. It is one division: a product with 1 / (1 + exp(-v))
// differs from the recorded traces in some bits.
template <typename Scalar>
Scalar times_sigmoid(Scalar value, Scalar v) {
  using elementary::exp;
  return value / (Scalar(1) + exp(-v));
}

template <typename Scalar>
Scalar arc_cosine(Scalar cosine) {
  if (cosine >= Scalar(1)) return Scalar(0);
  if (cosine <= Scalar(-1)) return pi<Scalar>;
  using elementary::acos;
  return acos(cosine);
}

// Folds the direction of the tilt axis into the first quadrant, where the functions were fitted.
template <typename Scalar>
RecoveryTilt<Scalar> fold(Scalar angle, Scalar direction) {
  if (direction < -half_pi<Scalar>) return {angle, direction + pi<Scalar>, {-1, -1, 1}};
  if (direction < Scalar(0)) return {angle, -direction, {-1, 1, -1}};
  if (direction < half_pi<Scalar>) return {angle, direction, {1, 1, 1}};
  return {angle, pi<Scalar> - direction, {1, -1, -1}};
}

}  // namespace recovery

template <typename Scalar>
RecoveryTilt<Scalar> RecoveryStages<Scalar>::tilt(const Quaternion<Scalar>& q_WB,
                                                  const Quaternion<Scalar>& q_WD) {
  const Vector up(Scalar(0), Scalar(0), Scalar(-1));
  const Vector turned = ordered::times(rotation_matrix(product(q_WB, conjugate(q_WD))), up);
  using elementary::atan2;
  using std::abs;
  const Scalar angle = recovery::arc_cosine(ordered::dot(turned, up));
  // At 0 and pi the cross product vanishes, and the law takes `up` as the axis.
  const Scalar from_singular = std::min(abs(angle), abs(angle - recovery::pi<Scalar>));
  const Vector axis_W = from_singular > Scalar(0.00001) ? ordered::cross(turned, up) : up;
  const Vector axis_B = ordered::transpose_times(rotation_matrix(q_WB), axis_W);
  return recovery::fold(angle, Scalar(atan2(axis_B[0], axis_B[1])));
}

template <typename Scalar>
bool RecoveryStages<Scalar>::latch(bool recovering, Scalar tilt_rad) {
  using std::abs;
  if (abs(tilt_rad) > radians(Scalar(30))) return true;
  if (abs(tilt_rad) < radians(Scalar(5))) return false;
  return recovering;
}

// Polynomials in the direction times sigmoids in the tilt, fitted to solutions of an optimal
// control problem. The numbers are those of PX4 v1.5.5 TailsitterRecovery.
template <typename Scalar>
Vector3<Scalar> RecoveryStages<Scalar>::optimal_rates(const RecoveryTilt<Scalar>& tilt) {
  using elementary::exp;
  using recovery::half_pi, recovery::pi, recovery::times_sigmoid;
  const Scalar x = tilt.angle_rad;
  const Scalar y = half_pi<Scalar> - tilt.direction_rad;
  const Scalar y_share = y / half_pi<Scalar>;

  const Scalar roll_gain = Scalar(3.997) * x;
  const Scalar roll =
      -roll_gain +
      y_share * y_share * times_sigmoid(roll_gain, Scalar(4.013) * (Scalar(2.133) - x));

  const Scalar pitch_gain = Scalar(1.676) * x;
  const Scalar pitch_slope = Scalar(2.642), pitch_centre = Scalar(0.3586);
  const Scalar at_half_turn = exp(pitch_slope * (pitch_centre - pi<Scalar>));
  const Scalar pitch =
      (Scalar(1.38) * y + Scalar(0.8725) * (y * y)) *
      (times_sigmoid(-pitch_gain, pitch_slope * (pitch_centre - x)) +
       times_sigmoid(pitch_gain * at_half_turn, pitch_slope * (pi<Scalar> - pitch_centre)));

  const Scalar yaw_gain = Scalar(2.726) * (x - pi<Scalar>);
  const Scalar yaw_slope = Scalar(2.298), yaw_centre = Scalar(1.75);
  const Scalar yaw = (Scalar(3.168) * y - Scalar(0.3913) * (y * y)) *
                     (times_sigmoid(yaw_gain, yaw_slope * (x - yaw_centre)) -
                      times_sigmoid(yaw_gain, -yaw_centre * yaw_slope));

  return {roll * -tilt.signs[0], pitch * (-tilt.signs[1] * Scalar(1.5)), yaw * -tilt.signs[2]};
}

template <typename Scalar>
Vector3<Scalar> RecoveryStages<Scalar>::quaternion_rates(const Quaternion<Scalar>& q_WB,
                                                         const Quaternion<Scalar>& q_WD,
                                                         const AttitudeGains<Scalar>& gains) {
  const Quaternion<Scalar> q_DB = product(conjugate(q_WD), q_WB);
  const Scalar sign = q_DB.w() > Scalar(0) ? Scalar(-2) : Scalar(2);
  Vector rates_sp = gains.proportional_1_s.cwiseProduct(imaginary_part(q_DB)) * sign;
  rates_sp[2] = clamp(rates_sp[2], Scalar(-1), Scalar(1));
  return rates_sp;
}

// Weighted by the vertical component of the vehicle's own z axis, not by that of the setpoint.
template <typename Scalar>
Scalar RecoveryStages<Scalar>::yaw_feed_forward(Scalar yaw_rate_sp, Scalar move_rate,
                                                const Quaternion<Scalar>& q_WB,
                                                const AttitudeGains<Scalar>& gains) {
  const Scalar upright = rotation_matrix(q_WB)(2, 2);
  const Scalar not_below_zero = upright > Scalar(0) ? upright : Scalar(0);
  const Scalar weight = clamp(not_below_zero, Scalar(0), Scalar(1));
  return yaw_rate_sp + move_rate * weight * gains.yaw_feed_forward;
}

template <typename Scalar>
Vector3<Scalar> RecoveryStages<Scalar>::limit(const Vector& rates_sp_B,
                                              const AttitudeGains<Scalar>& gains) {
  return clamp_each(rates_sp_B, gains.rate_max_rad_s);
}

}  // namespace attest::mc_att_control
