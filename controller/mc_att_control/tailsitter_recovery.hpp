// The outer loop of a tailsitter that recovers from a large tilt along an optimal path.
//
// The law of PX4 v1.5.5 TailsitterRecovery. A recovery begins beyond 30 deg of tilt error and ends
// below 5 deg. During a recovery the rate setpoint is a fitted function of the tilt and of the
// direction of the tilt axis; otherwise a plain quaternion law gives it. TailsitterRecovery
// replaces AttitudeControl if VT_TYPE is 0 and VT_OPT_RECOV_EN is not 0 at the first step.
//
// Frames: W world NED, B body FRD, D desired body. Angles [rad], rates [rad/s]. The only state is
// the flag of a recovery in progress. No clock, no allocation; one thread at a time.
#pragma once

#include <utility>

#include "controller/mc_att_control/gains.hpp"
#include "controller/mc_att_control/ordered.hpp"
#include "controller/mc_att_control/rotation.hpp"

namespace attest::mc_att_control {

// The error rotation q_WB q_WD^-1, in world axes, as arguments of the fitted functions.
template <typename Scalar>
struct RecoveryTilt {
  Scalar angle_rad;       // 0 .. pi, by which the error rotation tilts the vertical
  Scalar direction_rad;   // of the tilt axis in the body's x-y plane, folded into 0 .. pi/2
  Vector3<Scalar> signs;  // of the rates, to undo the folding
};

// The stages of the law, in the order they run.
template <typename Scalar>
struct RecoveryStages {
  using Vector = Vector3<Scalar>;

  static RecoveryTilt<Scalar> tilt(const Quaternion<Scalar>& q_WB, const Quaternion<Scalar>& q_WD);
  static bool latch(bool recovering, Scalar tilt_rad);
  static Vector optimal_rates(const RecoveryTilt<Scalar>& tilt);
  static Vector quaternion_rates(const Quaternion<Scalar>& q_WB, const Quaternion<Scalar>& q_WD,
                                 const AttitudeGains<Scalar>& gains);
  static Scalar yaw_feed_forward(Scalar yaw_rate_sp, Scalar move_rate,
                                 const Quaternion<Scalar>& q_WB,
                                 const AttitudeGains<Scalar>& gains);
  static Vector limit(const Vector& rates_sp_B, const AttitudeGains<Scalar>& gains);
};

// Stages is a policy: the stages of the law, or a copy with one replaced (controller/faults).
template <typename Scalar, typename Stages = RecoveryStages<Scalar>>
class TailsitterRecovery {
 public:
  explicit TailsitterRecovery(Stages stages = {}) : stages_(std::move(stages)) {}

  void set_gains(const AttitudeGains<Scalar>& gains) { gains_ = gains; }

  // The setpoint of the body rates [rad/s]. REQUIRES: set_gains() was called.
  Vector3<Scalar> update(const Quaternion<Scalar>& q_WB, const Quaternion<Scalar>& q_WD,
                         Scalar yaw_sp_move_rate_rad_s);

 private:
  AttitudeGains<Scalar> gains_{};
  bool recovering_ = false;
  [[no_unique_address]] Stages stages_;
};

template <typename Scalar, typename Stages>
Vector3<Scalar> TailsitterRecovery<Scalar, Stages>::update(const Quaternion<Scalar>& q_WB,
                                                           const Quaternion<Scalar>& q_WD,
                                                           Scalar yaw_sp_move_rate_rad_s) {
  const RecoveryTilt<Scalar> tilt = stages_.tilt(q_WB, q_WD);
  recovering_ = stages_.latch(recovering_, tilt.angle_rad);
  Vector3<Scalar> rates_sp =
      recovering_ ? stages_.optimal_rates(tilt) : stages_.quaternion_rates(q_WB, q_WD, gains_);
  rates_sp[2] = stages_.yaw_feed_forward(rates_sp[2], yaw_sp_move_rate_rad_s, q_WB, gains_);
  return stages_.limit(rates_sp, gains_);
}

extern template struct RecoveryStages<float>;
extern template struct RecoveryStages<double>;

}  // namespace attest::mc_att_control
