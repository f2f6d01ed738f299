/* SPDX-License-Identifier: BSD-3-Clause */
#include "controller.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace starter {

namespace {

Quat quat(const float (&q)[4]) noexcept { return {q[0], {{q[1], q[2], q[3]}}}; }

float finite_or_zero(float v) noexcept { return std::isfinite(v) ? v : 0.0f; }

}  // namespace

Controller::Controller(Profile profile) noexcept : profile_(profile), rate_loop_(profile) {
  copy_.vehicle_status.is_rotary_wing = 1;
}

// ---- inputs -------------------------------------------------------------------------------------

// Removes a bit from the pending samples. Returns whether it was set.
bool Controller::take(std::uint32_t updated_bit) noexcept {
  const bool was_pending = (pending_ & updated_bit) != 0;
  pending_ &= ~updated_bit;
  return was_pending;
}

template <typename Sample>
void Controller::latch(std::uint32_t updated_bit, Sample attest_inputs::*topic,
                       const attest_inputs& in) noexcept {
  if (take(updated_bit)) copy_.*topic = in.*topic;
}

// Latches every topic except the two setpoints, which the law latches in some modes only.
void Controller::latch_inputs(const attest_inputs& in) noexcept {
  pending_ |= in.updated;
  copy_.timestamp = in.timestamp;
  copy_.control_state = in.control_state;
  const bool started = gains_.has_value();
  if (take(ATTEST_UPDATED_PARAMETER_UPDATE) || !started) gains_.emplace(parameters_);
  // VT_TYPE 0 is the tailsitter. Later changes of these parameters have no effect.
  const bool recovery = parameters_.vtol_type == 0.0f && parameters_.recovery_enabled != 0.0f;
  if (!started && recovery) tailsitter_.emplace();
  if ((in.updated & ATTEST_UPDATED_VEHICLE_STATUS) != 0 && !topics_) {
    // The first sample selects the topics for the life of the instance.
    topics_ = in.vehicle_status.is_vtol ? Topics::virtual_of_vtol : Topics::of_multicopter;
  }
  latch(ATTEST_UPDATED_MANUAL_CONTROL_SETPOINT, &attest_inputs::manual_control_setpoint, in);
  latch(ATTEST_UPDATED_VEHICLE_CONTROL_MODE, &attest_inputs::vehicle_control_mode, in);
  latch(ATTEST_UPDATED_ACTUATOR_ARMED, &attest_inputs::actuator_armed, in);
  latch(ATTEST_UPDATED_VEHICLE_STATUS, &attest_inputs::vehicle_status, in);
  latch(ATTEST_UPDATED_MULTIROTOR_MOTOR_LIMITS, &attest_inputs::multirotor_motor_limits, in);
  latch(ATTEST_UPDATED_BATTERY_STATUS, &attest_inputs::battery_status, in);

  auto& mode = copy_.vehicle_control_mode;
  const auto& sticks = copy_.manual_control_setpoint;
  if (mode.flag_control_rattitude_enabled && (std::fabs(sticks.y) > gains_->rattitude_threshold ||
                                              std::fabs(sticks.x) > gains_->rattitude_threshold)) {
    // Cleared in the copy: attitude mode returns only with the next vehicle_control_mode.
    mode.flag_control_attitude_enabled = 0;
  }
}

// ---- the loops ----------------------------------------------------------------------------------

void Controller::attitude_mode() noexcept {
  const auto& setpoint = copy_.vehicle_attitude_setpoint;
  const auto& mode = copy_.vehicle_control_mode;
  const bool auto_counts = profile_ == Profile::px4_v1_5_5;
  AttitudeTask task;
  task.q = quat(copy_.control_state.q);
  task.q_d = quat(setpoint.q_d);
  task.yaw_sp_move_rate = setpoint.yaw_sp_move_rate;
  task.autonomous =
      !mode.flag_control_manual_enabled &&
      (mode.flag_control_velocity_enabled || (auto_counts && mode.flag_control_auto_enabled));
  task.weather_vane = task.autonomous && setpoint.disable_mc_yaw_control;
  thrust_sp_ = setpoint.thrust;
  if (tailsitter_) {
    rates_sp_ = tailsitter_->update(*gains_, task);
    return;
  }
  rates_sp_ = attitude_law(profile_, *gains_, task);
  // An integral would oppose the wind.
  if (task.weather_vane) rate_loop_.reset_yaw_integral();
}

void Controller::acro_mode() noexcept {
  const auto& sticks = copy_.manual_control_setpoint;
  const Vec3& max = gains_->acro_rate_max;
  rates_sp_ = {{sticks.y * max[0], -sticks.x * max[1], sticks.r * max[2]}};
  thrust_sp_ = sticks.z < 0.9f ? sticks.z : 0.9f;  // leaves headroom for control; NaN gives 0.9
}

void Controller::offboard_rates_mode() noexcept {
  const auto& setpoint = copy_.vehicle_rates_setpoint;
  rates_sp_ = {{setpoint.roll, setpoint.pitch, setpoint.yaw}};
  thrust_sp_ = setpoint.thrust;
}

void Controller::outer_loop(const attest_inputs& in, attest_outputs& out) noexcept {
  const auto& mode = copy_.vehicle_control_mode;
  if (mode.flag_control_attitude_enabled) {
    latch(ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT, &attest_inputs::vehicle_attitude_setpoint, in);
    attitude_mode();
    publish_rates_setpoint(out);
  } else if (mode.flag_control_manual_enabled) {
    acro_mode();
    publish_rates_setpoint(out);
  } else {
    latch(ATTEST_UPDATED_VEHICLE_RATES_SETPOINT, &attest_inputs::vehicle_rates_setpoint, in);
    offboard_rates_mode();
  }
}

Vec3 Controller::inner_loop(float dt) noexcept {
  // The integrals are updated in this step too, after the reset.
  if (!copy_.actuator_armed.armed || !copy_.vehicle_status.is_rotary_wing) {
    rate_loop_.reset_integrals();
  }
  const auto& state = copy_.control_state;
  const auto& limits = copy_.multirotor_motor_limits;
  RateTask task;
  task.rates_sp = rates_sp_;
  task.rates = {{state.roll_rate, state.pitch_rate, state.yaw_rate}};
  task.thrust_sp = thrust_sp_;
  task.tpa_thrust = copy_.vehicle_rates_setpoint.thrust;
  task.motors_at_limit = limits.lower_limit || limits.upper_limit;
  task.yaw_at_limit = limits.yaw != 0;
  return rate_loop_.update(*gains_, task, dt);
}

void Controller::step(const attest_inputs& in, attest_outputs& out) noexcept {
  out.vehicle_rates_setpoint.published = 0;
  out.actuator_controls_0.published = 0;
  out.mc_att_ctrl_status.published = 0;

  // The clamp is part of the law: above 500 Hz the law still uses 2 ms.
  const float elapsed = static_cast<float>(in.timestamp - copy_.timestamp) / 1000000.0f;
  const float dt = clamp(elapsed, 0.002f, 0.02f);
  latch_inputs(in);
  outer_loop(in, out);
  if (!copy_.vehicle_control_mode.flag_control_rates_enabled) return;
  publish_controls(inner_loop(dt), out);
  publish_status(out);
}

// ---- outputs ------------------------------------------------------------------------------------

void Controller::publish_rates_setpoint(attest_outputs& out) noexcept {
  copy_.vehicle_rates_setpoint = {rates_sp_[0], rates_sp_[1], rates_sp_[2], thrust_sp_};
  if (!topics_) return;
  // This newer sample supersedes a pending external one on the same topic.
  if (topics_ == Topics::of_multicopter) take(ATTEST_UPDATED_VEHICLE_RATES_SETPOINT);
  out.vehicle_rates_setpoint = {rates_sp_[0], rates_sp_[1], rates_sp_[2], thrust_sp_, 1};
}

void Controller::publish_controls(const Vec3& control, attest_outputs& out) const noexcept {
  if (gains_->circuit_breaker_open || !topics_) return;
  auto& c = out.actuator_controls_0.control;
  std::fill(std::begin(c), std::end(c), 0.0f);
  for (std::size_t i = 0; i < 3; ++i) c[i] = finite_or_zero(control[i]);
  c[3] = finite_or_zero(thrust_sp_);
  if (profile_ == Profile::px4_v1_5_5) {
    c[7] = copy_.vehicle_attitude_setpoint.landing_gear;
    // After the check for finite controls: an infinite scale gives infinite controls.
    const float scale = copy_.battery_status.scale;
    if (gains_->battery_scale_enabled && scale > 0.0f) {
      for (std::size_t i = 0; i < 4; ++i) c[i] *= scale;
    }
  }
  out.actuator_controls_0.published = 1;
}

void Controller::publish_status(attest_outputs& out) const noexcept {
  const Vec3& integrals = rate_loop_.integrals();
  out.mc_att_ctrl_status = {integrals[0], integrals[1], integrals[2], 1};
}

}  // namespace starter
