// The attitude loop: from an attitude and its setpoint to a setpoint of body rates.
//
// The law of PX4 v1.5.5 mc_att_control, control_attitude(). The tilt is corrected along the
// shortest arc of the thrust axis. Yaw is corrected about the desired thrust axis, with a weight
// that vanishes as the desired tilt approaches 90 deg. Beyond 90 deg of tilt error the result is
// blended with the shortest rotation of the whole attitude.
//
// Frames: W world NED, B body FRD, D desired body. R_WB maps body into world. Angles [rad], rates
// [rad/s]. Pure: no state beyond the gains, no clock, no allocation; const calls from any thread.
#pragma once

#include <cmath>
#include <utility>

#include "controller/elementary/elementary.hpp"
#include "controller/mc_att_control/gains.hpp"
#include "controller/mc_att_control/inline.hpp"
#include "controller/mc_att_control/ordered.hpp"
#include "controller/mc_att_control/profile.hpp"
#include "controller/mc_att_control/rotation.hpp"

namespace attest::mc_att_control {

template <typename Scalar>
struct AttitudeInput {
  Quaternion<Scalar> q_WB;
  Quaternion<Scalar> q_WD;
  Scalar yaw_sp_move_rate_rad_s;  // commanded by the pilot
  bool autonomous;                // the vehicle, not a pilot, sets the attitude
  bool weathervane;               // the wind may turn the nose; implies autonomous
};

// Error of the thrust axis: the shortest rotation of the body that aligns it with the desired one.
template <typename Scalar>
struct TiltError {
  Vector3<Scalar> rotation_B;  // axis times angle
  Vector3<Scalar> axis_B;      // set only if sine > 0
  Scalar sine;
  Scalar cosine;
};

// The stages of the law. Each is a pure function of its arguments.
template <typename Scalar>
struct AttitudeStages {
  using Vector = Vector3<Scalar>;
  using Matrix = Matrix3<Scalar>;

  ATTEST_INLINE static TiltError<Scalar> tilt_error(const Matrix& R_WB, const Matrix& R_WD) {
    const Vector z_B_W = R_WB.col(2);
    const Vector z_D_W = R_WD.col(2);
    TiltError<Scalar> tilt;
    tilt.rotation_B = ordered::transpose_times(R_WB, ordered::cross(z_B_W, z_D_W));
    tilt.sine = ordered::length(tilt.rotation_B);
    tilt.cosine = ordered::dot(z_B_W, z_D_W);
    using elementary::atan2;
    if (tilt.sine > Scalar(0)) {
      const Scalar angle = atan2(tilt.sine, tilt.cosine);
      tilt.axis_B = tilt.rotation_B / tilt.sine;
      tilt.rotation_B = tilt.axis_B * angle;
    }
    return tilt;
  }

  // Where the nose points after the tilt alone is corrected: the first column of
  // R_WB ((I + K sin) + K K (1 - cos)), Rodrigues' formula. The law uses no other column.
  ATTEST_INLINE static Vector nose_after_tilt(const Matrix& R_WB, const TiltError<Scalar>& tilt) {
    if (!(tilt.sine > Scalar(0))) return R_WB.col(0);
    const Matrix K = cross_product_matrix(tilt.axis_B);
    const Vector K_x = K.col(0);
    const Vector x(Scalar(1), Scalar(0), Scalar(0));
    const Vector turned =
        (x + K_x * tilt.sine) + ordered::product_column(K, K_x) * (Scalar(1) - tilt.cosine);
    return ordered::product_column(R_WB, turned);
  }

  // 1 if the desired attitude is level or upside down, 0 at 90 deg of tilt: yaw has no meaning
  // there.
  ATTEST_INLINE static Scalar yaw_weight(const Matrix& R_WD) { return R_WD(2, 2) * R_WD(2, 2); }

  // Angle about the desired thrust axis from nose_after_tilt() to the desired nose, times `weight`.
  ATTEST_INLINE static Scalar yaw_error(const Vector& nose_W, const Matrix& R_WD, Scalar weight) {
    const Vector x_D_W = R_WD.col(0);
    const Vector z_D_W = R_WD.col(2);
    using elementary::atan2;  // a user-defined scalar type provides its own overload
    return atan2(ordered::dot(ordered::cross(nose_W, x_D_W), z_D_W), ordered::dot(nose_W, x_D_W)) *
           weight;
  }

  // Twice the imaginary part of the quaternion from R_WB to R_WD, for the shorter rotation.
  static Vector direct_error(const Matrix& R_WB, const Matrix& R_WD) {
    const Quaternion<Scalar> q_BD = quaternion_of(ordered::transpose_product(R_WB, R_WD));
    const Vector imaginary = imaginary_part(q_BD);
    return q_BD.w() >= Scalar(0) ? Vector(imaginary * Scalar(2)) : Vector(-imaginary * Scalar(2));
  }

  // Whether the tilt error is beyond 90 deg.
  ATTEST_INLINE static bool is_upset(Scalar tilt_cosine) { return tilt_cosine < Scalar(0); }

  // The share of the direct rotation grows from 0 at 90 deg of tilt error.
  ATTEST_INLINE static Vector blend(const Vector& error_B, const Vector& direct_B,
                                    Scalar tilt_cosine, Scalar weight) {
    const Scalar share = tilt_cosine * tilt_cosine * weight;
    return error_B * (Scalar(1) - share) + direct_B * share;
  }

  ATTEST_INLINE static Vector proportional(const Vector& error_B,
                                           const AttitudeGains<Scalar>& gains) {
    return gains.proportional_1_s.cwiseProduct(error_B);
  }

  ATTEST_INLINE static Vector limit(const Vector& rates_sp_B, bool autonomous,
                                    const AttitudeGains<Scalar>& gains) {
    return clamp_each(rates_sp_B, autonomous ? gains.auto_rate_max_rad_s : gains.rate_max_rad_s);
  }

  ATTEST_INLINE static Scalar yaw_feed_forward(Scalar yaw_rate_sp, Scalar move_rate, Scalar weight,
                                               const AttitudeGains<Scalar>& gains) {
    return yaw_rate_sp + move_rate * weight * gains.yaw_feed_forward;
  }

  ATTEST_INLINE static Scalar weathervane_limit(Scalar yaw_rate_sp,
                                                const AttitudeGains<Scalar>& gains) {
    const Scalar bound = gains.auto_rate_max_rad_s[2] * gains.weathervane_scale;
    return clamp(yaw_rate_sp, -bound, bound);
  }
};

// Stages is a policy: the stages of the law, or a copy with one replaced (controller/faults).
template <typename Scalar, typename Stages = AttitudeStages<Scalar>>
class AttitudeControl {
 public:
  explicit AttitudeControl(Profile profile, Stages stages = {})
      : profile_(profile), stages_(std::move(stages)) {}

  void set_gains(const AttitudeGains<Scalar>& gains) { gains_ = gains; }

  // The setpoint of the body rates [rad/s]. REQUIRES: set_gains() was called.
  Vector3<Scalar> update(const AttitudeInput<Scalar>& in) const;

 private:
  Vector3<Scalar> error(const Matrix3<Scalar>& R_WB, const Matrix3<Scalar>& R_WD,
                        Scalar weight) const;

  Profile profile_;
  AttitudeGains<Scalar> gains_{};
  [[no_unique_address]] Stages stages_;
};

// Attitude error [rad, body axes]: the rotation to the desired attitude, with its yaw weighted.
template <typename Scalar, typename Stages>
ATTEST_INLINE Vector3<Scalar> AttitudeControl<Scalar, Stages>::error(const Matrix3<Scalar>& R_WB,
                                                                     const Matrix3<Scalar>& R_WD,
                                                                     Scalar weight) const {
  const TiltError<Scalar> tilt = stages_.tilt_error(R_WB, R_WD);
  Vector3<Scalar> error_B = tilt.rotation_B;
  error_B[2] = stages_.yaw_error(stages_.nose_after_tilt(R_WB, tilt), R_WD, weight);
  if (stages_.is_upset(tilt.cosine)) {
    error_B = stages_.blend(error_B, stages_.direct_error(R_WB, R_WD), tilt.cosine, weight);
  }
  return error_B;
}

template <typename Scalar, typename Stages>
ATTEST_INLINE Vector3<Scalar> AttitudeControl<Scalar, Stages>::update(
    const AttitudeInput<Scalar>& in) const {
  const Matrix3<Scalar> R_WB = rotation_matrix(in.q_WB);
  const Matrix3<Scalar> R_WD = rotation_matrix(in.q_WD);
  const Scalar weight = stages_.yaw_weight(R_WD);
  const Vector3<Scalar> error_B = error(R_WB, R_WD, weight);
  Vector3<Scalar> rates_sp =
      stages_.limit(stages_.proportional(error_B, gains_), in.autonomous, gains_);
  Scalar& yaw = rates_sp[2];
  if (in.weathervane && traits_of(profile_).limits_yaw_before_feed_forward) {
    yaw = stages_.weathervane_limit(yaw, gains_);
  }
  yaw = stages_.yaw_feed_forward(yaw, in.yaw_sp_move_rate_rad_s, weight, gains_);
  if (in.weathervane) yaw = stages_.weathervane_limit(yaw, gains_);
  return rates_sp;
}

}  // namespace attest::mc_att_control
