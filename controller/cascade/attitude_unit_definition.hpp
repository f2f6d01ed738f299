// The definitions of AttitudeUnit, for code that instantiates it with another law.
#pragma once

#include "controller/cascade/attitude_unit.hpp"

namespace attest::cascade {

template <typename Scalar, typename Law>
AttitudeUnit<Scalar, Law>::AttitudeUnit(Profile profile, const Law& law)
    : profile_(profile),
      traits_(law.step.traits(profile)),
      parameters_(default_parameters(attitude_parameters(), profile)),
      stages_(law.step),
      sticks_(traits_, law.sticks),
      attitude_(traits_.follows_reference_model, law.attitude, law.model) {}

template <typename Scalar, typename Law>
bool AttitudeUnit<Scalar, Law>::set_parameter(std::string_view name, float value) {
  return attest::set_parameter(parameters_, attitude_parameters(), profile_, name, value);
}

template <typename Scalar, typename Law>
void AttitudeUnit<Scalar, Law>::step(const attest_attitude_inputs& in,
                                     attest_attitude_outputs& out) {
  out.vehicle_rates_setpoint.published = 0;
  out.vehicle_attitude_setpoint.published = 0;
  if (first_step_ || (in.updated & ATTEST_ATTITUDE_UPDATED_PARAMETER_UPDATE) != 0) {
    read_parameters();
  }
  latch_newest(in);
  const auto& attitude = in.vehicle_attitude;
  dt_s_ = stages_.step_time(attitude.timestamp_sample, last_sample_us_);
  last_sample_us_ = attitude.timestamp_sample;
  if (traits_.latches_in_every_step) {
    take_attitude_setpoint();
    follow_estimator_reset(in);
  }
  latch_topics(in);

  const bool runs = stages_.runs(topics_);
  const bool follows_sticks = runs && stages_.follows_sticks(topics_);
  if (follows_sticks) {
    follow_sticks(in, out);
  } else {
    sticks_.release(quaternion_from<Scalar>(attitude.q), Scalar(topics_.position.unaided_heading),
                    runs);
  }
  if (runs) publish_rates(in, out);
  move_thrust_limits();
  sticks_.set_restart(stages_.restarts_yaw(follows_sticks, topics_));
}

template <typename Scalar, typename Law>
void AttitudeUnit<Scalar, Law>::read_parameters() {
  first_step_ = false;
  gains_ = stages_.gains(parameters_);
  attitude_.set_gains(gains_);
  sticks_.set_gains(gains_.sticks);
  if (!is_finite(hover_estimate_)) thrust_limits_.hover = gains_.sticks.thrust_hover;
}

// Stores the newest samples of the attitude setpoint and of autotune, which the law may use in a
// later step, and updates the hover thrust estimate.
template <typename Scalar, typename Law>
void AttitudeUnit<Scalar, Law>::latch_newest(const attest_attitude_inputs& in) {
  const auto updated = [&in](std::uint32_t topic) { return (in.updated & topic) != 0; };
  const bool new_setpoint = updated(ATTEST_ATTITUDE_UPDATED_VEHICLE_ATTITUDE_SETPOINT);
  setpoint_pending_ = stages_.is_pending(setpoint_pending_, new_setpoint);
  if (new_setpoint) {
    const auto& setpoint = in.vehicle_attitude_setpoint;
    newest_setpoint_ = {setpoint.timestamp, quaternion_from<Scalar>(setpoint.q_d),
                        vector_from<Scalar>(setpoint.thrust_body),
                        Scalar(setpoint.yaw_sp_move_rate)};
  }
  if (updated(ATTEST_ATTITUDE_UPDATED_AUTOTUNE_ATTITUDE_CONTROL_STATUS)) {
    topics_.autotune = in.autotune_attitude_control_status;
  }
  if (traits_.follows_hover_estimate && updated(ATTEST_ATTITUDE_UPDATED_HOVER_THRUST_ESTIMATE)) {
    hover_estimate_ = stages_.hover_estimate(in.hover_thrust_estimate, gains_.sticks);
  }
}

template <typename Scalar, typename Law>
void AttitudeUnit<Scalar, Law>::latch_topics(const attest_attitude_inputs& in) {
  const auto updated = [&in](std::uint32_t topic) { return (in.updated & topic) != 0; };
  if (updated(ATTEST_ATTITUDE_UPDATED_MANUAL_CONTROL_SETPOINT)) {
    topics_.manual = in.manual_control_setpoint;
  }
  if (updated(ATTEST_ATTITUDE_UPDATED_VEHICLE_CONTROL_MODE)) topics_.mode = in.vehicle_control_mode;
  if (updated(ATTEST_ATTITUDE_UPDATED_VEHICLE_STATUS)) {
    topics_.status = in.vehicle_status;
    topics_.spooled = stages_.is_spooled(in.timestamp, topics_.status, gains_.spoolup_us);
  }
  if (updated(ATTEST_ATTITUDE_UPDATED_VEHICLE_LAND_DETECTED)) {
    topics_.landed = in.vehicle_land_detected.landed != 0;
  }
  if (updated(ATTEST_ATTITUDE_UPDATED_VEHICLE_LOCAL_POSITION)) {
    topics_.position = in.vehicle_local_position;
  }
}

template <typename Scalar, typename Law>
void AttitudeUnit<Scalar, Law>::follow_sticks(const attest_attitude_inputs& in,
                                              attest_attitude_outputs& out) {
  const auto& position = topics_.position;
  AttitudeSetpoint<Scalar> setpoint =
      sticks_.update({.q_WB = quaternion_from<Scalar>(in.vehicle_attitude.q),
                      .sticks = topics_.manual,
                      .thrust = thrust_limits_,
                      .dt_s = dt_s_,
                      .unaided_heading = Scalar(position.unaided_heading),
                      .heading_good = position.heading_good_for_control != 0,
                      .is_vtol = topics_.status.is_vtol != 0});
  setpoint.timestamp_us = in.timestamp;
  publish_attitude_setpoint(setpoint, out);
  if (traits_.flies_own_setpoint_directly) set_attitude_setpoint(setpoint);
  if (setpoint_pending_ && !stages_.supersedes_pending()) return;
  newest_setpoint_ = setpoint;
  setpoint_pending_ = true;
}

template <typename Scalar, typename Law>
void AttitudeUnit<Scalar, Law>::publish_attitude_setpoint(const AttitudeSetpoint<Scalar>& setpoint,
                                                          attest_attitude_outputs& out) {
  auto& topic = out.vehicle_attitude_setpoint;
  for (int i = 0; i < 4; ++i) topic.q_d[i] = float(setpoint.q_WD[i]);
  for (int i = 0; i < 3; ++i) topic.thrust_body[i] = float(setpoint.thrust_B[i]);
  topic.yaw_sp_move_rate = float(setpoint.yaw_rate);
  topic.published = 1;
}

// A pending sample that is not newer than the last setpoint in use is dropped.
template <typename Scalar, typename Law>
void AttitudeUnit<Scalar, Law>::take_attitude_setpoint() {
  if (!setpoint_pending_) return;
  setpoint_pending_ = false;
  if (stages_.is_newer(newest_setpoint_.timestamp_us, last_setpoint_us_)) {
    set_attitude_setpoint(newest_setpoint_);
  }
}

template <typename Scalar, typename Law>
void AttitudeUnit<Scalar, Law>::set_attitude_setpoint(const AttitudeSetpoint<Scalar>& setpoint) {
  attitude_.set_setpoint(setpoint.q_WD, setpoint.yaw_rate, setpoint.timestamp_us,
                         last_setpoint_us_);
  thrust_B_ = setpoint.thrust_B;
  last_setpoint_us_ = setpoint.timestamp_us;
}

template <typename Scalar, typename Law>
void AttitudeUnit<Scalar, Law>::follow_estimator_reset(const attest_attitude_inputs& in) {
  const auto& attitude = in.vehicle_attitude;
  if (attitude.quat_reset_counter == reset_counter_) return;
  reset_counter_ = attitude.quat_reset_counter;
  const Quaternion<Scalar> delta = quaternion_from<Scalar>(attitude.delta_q_reset);
  sticks_.reset_heading(delta);
  if (stages_.precedes_reset(last_setpoint_us_, attitude.timestamp)) {
    attitude_.adapt_setpoint(delta);
  }
}

template <typename Scalar, typename Law>
void AttitudeUnit<Scalar, Law>::publish_rates(const attest_attitude_inputs& in,
                                              attest_attitude_outputs& out) {
  if (!traits_.latches_in_every_step) {
    take_attitude_setpoint();
    follow_estimator_reset(in);
  }
  const Vector3<Scalar> rates =
      stages_.autotuned(attitude_.update(quaternion_from<Scalar>(in.vehicle_attitude.q)), topics_,
                        in.timestamp, traits_);
  auto& topic = out.vehicle_rates_setpoint;
  topic.roll = float(rates[0]);
  topic.pitch = float(rates[1]);
  topic.yaw = float(rates[2]);
  for (int i = 0; i < 3; ++i) topic.thrust_body[i] = float(thrust_B_[i]);
  topic.published = 1;
}

// Runs in every step, after the sticks have used the limits.
template <typename Scalar, typename Law>
void AttitudeUnit<Scalar, Law>::move_thrust_limits() {
  ThrustLimits<Scalar>& limits = thrust_limits_;
  limits.min = stages_.thrust_min(limits.min, dt_s_, topics_.landed, gains_.sticks);
  limits.max = stages_.thrust_max(limits.max, dt_s_, topics_.spooled);
  limits.hover = stages_.hover_thrust(limits.hover, dt_s_, hover_estimate_);
}

}  // namespace attest::cascade
