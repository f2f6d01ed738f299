// The stabilized mode: an attitude setpoint from the sticks.
//
// Roll and pitch stick command a tilt, the yaw stick a yaw rate about the world's z axis, the
// throttle stick a thrust. Without a yaw rate the heading is held from v1.16.0 on; older profiles
// integrate the yaw rate.
//
// Frames: W world NED, B body FRD, D desired body. No clock, no allocation; one thread at a time.
#pragma once

#include <cstdint>
#include <utility>

#include "controller/attest_cascade.h"
#include "controller/cascade/stick_stages.hpp"

namespace attest::cascade {

// The topic vehicle_attitude_setpoint.
template <typename Scalar>
struct AttitudeSetpoint {
  std::uint64_t timestamp_us = 0;
  Quaternion<Scalar> q_WD = Quaternion<Scalar>::Zero();
  Vector3<Scalar> thrust_B = Vector3<Scalar>::Zero();
  Scalar yaw_rate = Scalar(0);  // yaw_sp_move_rate [rad/s] about the world's z axis
};

template <typename Scalar>
struct StickInput {
  Quaternion<Scalar> q_WB;
  decltype(attest_attitude_inputs::manual_control_setpoint) sticks;
  ThrustLimits<Scalar> thrust;
  Scalar dt_s;
  Scalar unaided_heading;  // [rad]; not finite if not available
  bool heading_good;
  bool is_vtol;
};

// Stages is a policy: the stages of the law, or a copy with one replaced.
template <typename Scalar, typename Stages = StickStages<Scalar>>
class Sticks {
 public:
  explicit Sticks(const ProfileTraits& traits, Stages stages = {})
      : traits_(traits), stages_(std::move(stages)) {}

  void set_gains(const StickGains<Scalar>& gains) { gains_ = gains; }

  // A step in stabilized mode. The caller sets the setpoint's timestamp. REQUIRES: set_gains() was
  // called.
  AttitudeSetpoint<Scalar> update(const StickInput<Scalar>& in);

  // A step outside stabilized mode. `runs`: the unit controls the attitude in this step.
  void release(const Quaternion<Scalar>& q_WB, Scalar unaided_heading, bool runs);

  // The estimator was reset by the rotation `delta`.
  void reset_heading(const Quaternion<Scalar>& delta);

  // Up to v1.15.4: whether the next step in stabilized mode takes the heading as its yaw setpoint.
  void set_restart(bool restart) { restart_ = restart; }

 private:
  Scalar lock_yaw(const StickInput<Scalar>& in, Scalar heading);
  Scalar integrate_yaw(const StickInput<Scalar>& in, Scalar heading);
  Quaternion<Scalar> tilt(const StickInput<Scalar>& in);
  Scalar thrust(const StickInput<Scalar>& in) const;

  ProfileTraits traits_;
  StickGains<Scalar> gains_{};
  LowPass<Scalar> roll_, pitch_, yaw_rate_;
  YawCorrection<Scalar> correction_;
  Scalar yaw_sp_ = Scalar(0);  // [rad]; NaN: no heading is held; at the start 0, north
  bool restart_ = true;
  [[no_unique_address]] Stages stages_;
};

template <typename Scalar, typename Stages>
AttitudeSetpoint<Scalar> Sticks<Scalar, Stages>::update(const StickInput<Scalar>& in) {
  const Scalar heading = stages_.heading(in.q_WB, traits_);
  AttitudeSetpoint<Scalar> setpoint;
  setpoint.yaw_rate = traits_.locks_yaw ? lock_yaw(in, heading) : integrate_yaw(in, heading);
  const bool follows = traits_.locks_yaw && !is_finite(yaw_sp_);
  const Quaternion<Scalar> yaw = yaw_rotation(follows ? heading : yaw_sp_);
  Quaternion<Scalar> tilted = tilt(in);
  if (in.is_vtol) tilted = stages_.tilt_for_yaw_error(tilted, yaw, in.q_WB);
  setpoint.q_WD = stages_.desired_attitude(yaw, tilted);
  setpoint.thrust_B = {Scalar(0), Scalar(0), -thrust(in)};
  return setpoint;
}

// Returns the yaw rate. The order is that of the law: the lock is released before the correction,
// which may release it too.
template <typename Scalar, typename Stages>
Scalar Sticks<Scalar, Stages>::lock_yaw(const StickInput<Scalar>& in, Scalar heading) {
  const bool lowest = stages_.is_lowest_throttle(Scalar(in.sticks.throttle), gains_);
  if (lowest || (traits_.reads_heading_good && !in.heading_good)) yaw_sp_ = stages_.no_yaw();
  const Scalar old_correction = correction_.value;
  if (stages_.correct_yaw(correction_, heading, in.unaided_heading, in.dt_s, traits_)) {
    yaw_sp_ = stages_.no_yaw();
  }
  const Scalar commanded = stages_.shaped_yaw_rate(Scalar(in.sticks.yaw), gains_);
  const Scalar rate = yaw_rate_.update(gains_.yaw_tau_s, in.dt_s, commanded, traits_);
  yaw_sp_ = stages_.locked_yaw(yaw_sp_, rate, heading, old_correction, correction_.value);
  return rate;
}

template <typename Scalar, typename Stages>
Scalar Sticks<Scalar, Stages>::integrate_yaw(const StickInput<Scalar>& in, Scalar heading) {
  const Scalar rate = stages_.straight_yaw_rate(Scalar(in.sticks.yaw), gains_);
  const bool lowest = stages_.is_lowest_throttle(Scalar(in.sticks.throttle), gains_);
  yaw_sp_ = restart_ || lowest ? heading : stages_.integrated_yaw(yaw_sp_, rate, in.dt_s);
  return rate;
}

// Pitch forward is a negative rotation about the body's y axis.
template <typename Scalar, typename Stages>
Quaternion<Scalar> Sticks<Scalar, Stages>::tilt(const StickInput<Scalar>& in) {
  const Scalar max = gains_.tilt_max_rad;
  const Scalar tau_s = gains_.tilt_tau_s;
  const Scalar x = roll_.update(tau_s, in.dt_s, Scalar(in.sticks.roll) * max, traits_);
  const Scalar y = -pitch_.update(tau_s, in.dt_s, Scalar(in.sticks.pitch) * max, traits_);
  return stages_.tilt(stages_.limited_tilt(x, y, gains_));
}

template <typename Scalar, typename Stages>
Scalar Sticks<Scalar, Stages>::thrust(const StickInput<Scalar>& in) const {
  const Scalar stick = Scalar(in.sticks.throttle);
  if (!traits_.spools_up) return stages_.uncentred_throttle(stick, gains_);
  return stages_.limited_thrust(stages_.throttle(stick, gains_, in.thrust), in.thrust);
}

template <typename Scalar, typename Stages>
void Sticks<Scalar, Stages>::release(const Quaternion<Scalar>& q_WB, Scalar unaided_heading,
                                     bool runs) {
  if (stages_.clears_tilt(runs, traits_)) {
    roll_.state = Scalar(0);
    pitch_.state = Scalar(0);
  }
  if (!traits_.locks_yaw) return;
  yaw_sp_ = stages_.no_yaw();
  if (is_finite(unaided_heading)) {
    correction_.error.state = wrap(stages_.heading(q_WB, traits_) - unaided_heading);
  }
}

template <typename Scalar, typename Stages>
void Sticks<Scalar, Stages>::reset_heading(const Quaternion<Scalar>& delta) {
  const Scalar turn = stages_.heading(delta, traits_);
  yaw_sp_ = stages_.turned(yaw_sp_, turn);
  correction_.error.state = stages_.turned(correction_.error.state, turn);
  correction_.reference = stages_.turned(correction_.reference, turn);
}

}  // namespace attest::cascade
