// The definitions of McAttControl, for code that instantiates it with another law
// (controller/faults).
#pragma once

#include <cmath>

#include "controller/mc_att_control/inline.hpp"
#include "controller/mc_att_control/mc_att_control.hpp"
#include "controller/mc_att_control/tailsitter_recovery_definition.hpp"

namespace attest::mc_att_control {

// Topics that are latched when the outer loop uses them, which may be some steps after they arrive.
inline constexpr std::uint32_t latched_on_demand =
    ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT | ATTEST_UPDATED_VEHICLE_RATES_SETPOINT;

template <typename Scalar, typename Law>
McAttControl<Scalar, Law>::McAttControl(Profile profile, const Law& law)
    : profile_(profile),
      parameters_(default_parameters()),
      stages_(law.step),
      attitude_(profile, law.attitude),
      rate_(profile, law.rate),
      recovery_(law.recovery) {}

template <typename Scalar, typename Law>
bool McAttControl<Scalar, Law>::set_parameter(std::string_view name, float value) {
  return mc_att_control::set_parameter(parameters_, profile_, name, value);
}

template <typename Scalar, typename Law>
void McAttControl<Scalar, Law>::step(const attest_inputs& in, attest_outputs& out) {
  out.vehicle_rates_setpoint.published = 0;
  out.actuator_controls_0.published = 0;
  out.mc_att_ctrl_status.published = 0;

  const Scalar dt_s = stages_.step_time(in.timestamp, last_timestamp_us_);
  last_timestamp_us_ = in.timestamp;
  latch_topics(in);
  apply_rattitude();
  const RateCommand<Scalar> command = outer_loop(in, out);
  if (topics_.mode.flag_control_rates_enabled != 0) inner_loop(in, command, dt_s, out);
}

template <typename Scalar, typename Law>
ATTEST_INLINE void McAttControl<Scalar, Law>::latch_topics(const attest_inputs& in) {
  const auto updated = [&in](std::uint32_t topic) { return (in.updated & topic) != 0; };
  pending_ |= in.updated & latched_on_demand;
  if (first_step_ || updated(ATTEST_UPDATED_PARAMETER_UPDATE)) apply_parameters();

  if (updated(ATTEST_UPDATED_MANUAL_CONTROL_SETPOINT)) topics_.manual = in.manual_control_setpoint;
  if (updated(ATTEST_UPDATED_VEHICLE_CONTROL_MODE)) topics_.mode = in.vehicle_control_mode;
  if (updated(ATTEST_UPDATED_ACTUATOR_ARMED)) topics_.armed = in.actuator_armed.armed != 0;
  if (updated(ATTEST_UPDATED_BATTERY_STATUS)) topics_.battery_scale = in.battery_status.scale;
  if (updated(ATTEST_UPDATED_VEHICLE_STATUS)) {
    topics_.is_rotary_wing = in.vehicle_status.is_rotary_wing != 0;
    if (!status_seen_) is_vtol_ = in.vehicle_status.is_vtol != 0;
    status_seen_ = true;
  }
  if (updated(ATTEST_UPDATED_MULTIROTOR_MOTOR_LIMITS)) {
    const auto& limits = in.multirotor_motor_limits;
    topics_.limits = {limits.lower_limit != 0, limits.upper_limit != 0, limits.yaw != 0};
  }
}

template <typename Scalar, typename Law>
ATTEST_INLINE bool McAttControl<Scalar, Law>::take_pending(std::uint32_t topic) {
  const bool was_pending = (pending_ & topic) != 0;
  pending_ &= ~topic;
  return was_pending;
}

template <typename Scalar, typename Law>
void McAttControl<Scalar, Law>::apply_parameters() {
  gains_ = stages_.gains(parameters_);
  attitude_.set_gains(gains_.attitude);
  rate_.set_gains(gains_.rate);
  recovery_.set_gains(gains_.attitude);
  if (first_step_) {
    recovery_enabled_ = parameters_.vt_type == 0.0f && parameters_.vt_opt_recov_en != 0.0f;
    first_step_ = false;
  }
}

// If a stick is beyond the threshold, clears the attitude flag in the latched copy. The flag stays
// cleared until vehicle_control_mode is updated, even if the stick returns before that.
template <typename Scalar, typename Law>
ATTEST_INLINE void McAttControl<Scalar, Law>::apply_rattitude() {
  if (topics_.mode.flag_control_rattitude_enabled == 0) return;
  if (stages_.sticks_beyond(topics_.manual, gains_.rattitude_threshold)) {
    topics_.mode.flag_control_attitude_enabled = 0;
  }
}

template <typename Scalar, typename Law>
ATTEST_INLINE RateCommand<Scalar> McAttControl<Scalar, Law>::outer_loop(const attest_inputs& in,
                                                                        attest_outputs& out) {
  const bool attitude = topics_.mode.flag_control_attitude_enabled != 0;
  const bool manual = topics_.mode.flag_control_manual_enabled != 0;
  if (!attitude && !manual) return follow_rates_setpoint(in);
  const RateCommand<Scalar> command =
      attitude ? control_attitude(in) : stages_.acro(topics_.manual, gains_);
  publish_rates_setpoint(command, out);
  return command;
}

template <typename Scalar, typename Law>
ATTEST_INLINE RateCommand<Scalar> McAttControl<Scalar, Law>::control_attitude(
    const attest_inputs& in) {
  if (take_pending(ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT)) {
    topics_.attitude_setpoint = in.vehicle_attitude_setpoint;
  }
  const auto& setpoint = topics_.attitude_setpoint;
  const Quaternion<Scalar> q_WB = quaternion_from<Scalar>(in.control_state.q);
  const Quaternion<Scalar> q_WD = quaternion_from<Scalar>(setpoint.q_d);
  const Scalar move_rate = Scalar(setpoint.yaw_sp_move_rate);
  const Scalar thrust_sp = Scalar(setpoint.thrust);
  if (recovery_enabled_) return {recovery_.update(q_WB, q_WD, move_rate), thrust_sp};

  const bool autonomous = stages_.is_autonomous(topics_.mode, profile_);
  const bool weathervane = stages_.is_weathervaning(autonomous, setpoint);
  if (weathervane) rate_.reset_yaw_integral();
  return {attitude_.update({q_WB, q_WD, move_rate, autonomous, weathervane}), thrust_sp};
}

template <typename Scalar, typename Law>
ATTEST_INLINE RateCommand<Scalar> McAttControl<Scalar, Law>::follow_rates_setpoint(
    const attest_inputs& in) {
  if (take_pending(ATTEST_UPDATED_VEHICLE_RATES_SETPOINT)) {
    topics_.rates_setpoint = in.vehicle_rates_setpoint;
  }
  const auto& setpoint = topics_.rates_setpoint;
  return {Vector3<Scalar>(Scalar(setpoint.roll), Scalar(setpoint.pitch), Scalar(setpoint.yaw)),
          Scalar(setpoint.thrust)};
}

template <typename Scalar, typename Law>
ATTEST_INLINE void McAttControl<Scalar, Law>::publish_rates_setpoint(
    const RateCommand<Scalar>& command, attest_outputs& out) {
  const Vector3<Scalar>& rates_sp = command.rates_sp_B;
  topics_.rates_setpoint = {float(rates_sp[0]), float(rates_sp[1]), float(rates_sp[2]),
                            float(command.thrust_sp)};
  if (!status_seen_) return;
  const auto& setpoint = topics_.rates_setpoint;
  out.vehicle_rates_setpoint = {setpoint.roll, setpoint.pitch, setpoint.yaw, setpoint.thrust, 1};
  if (stages_.supersedes_pending(is_vtol_)) take_pending(ATTEST_UPDATED_VEHICLE_RATES_SETPOINT);
}

template <typename Scalar, typename Law>
ATTEST_INLINE void McAttControl<Scalar, Law>::inner_loop(const attest_inputs& in,
                                                         const RateCommand<Scalar>& command,
                                                         Scalar dt_s, attest_outputs& out) {
  const auto& state = in.control_state;
  RateInput<Scalar> input;
  input.rates_B =
      Vector3<Scalar>(Scalar(state.roll_rate), Scalar(state.pitch_rate), Scalar(state.yaw_rate));
  input.rates_sp_B = command.rates_sp_B;
  input.thrust_sp = command.thrust_sp;
  input.published_thrust_sp = Scalar(topics_.rates_setpoint.thrust);
  input.dt_s = dt_s;
  input.limits = topics_.limits;
  input.flying = stages_.is_flying(topics_);
  const Vector3<Scalar> control = rate_.update(input);
  if (status_seen_ && !gains_.actuators_cut) publish_actuators(control, command.thrust_sp, out);
  publish_status(out);
}

template <typename Scalar, typename Law>
ATTEST_INLINE void McAttControl<Scalar, Law>::publish_actuators(const Vector3<Scalar>& control,
                                                                Scalar thrust_sp,
                                                                attest_outputs& out) const {
  auto& actuators = out.actuator_controls_0;
  for (int i = 0; i < 3; ++i) actuators.control[i] = stages_.guarded(float(control[i]));
  actuators.control[3] = stages_.guarded(float(thrust_sp));
  for (int i = 4; i < 8; ++i) actuators.control[i] = 0.0f;
  if (traits_of(profile_).has_landing_gear) {
    actuators.control[7] = topics_.attitude_setpoint.landing_gear;
  }
  // A factor of 1 changes no bit.
  const float factor = stages_.battery_factor(topics_, gains_, profile_);
  for (int i = 0; i < 4; ++i) actuators.control[i] *= factor;
  actuators.published = 1;
}

template <typename Scalar, typename Law>
ATTEST_INLINE void McAttControl<Scalar, Law>::publish_status(attest_outputs& out) const {
  const Vector3<Scalar>& integral = rate_.integral();
  out.mc_att_ctrl_status = {float(integral[0]), float(integral[1]), float(integral[2]), 1};
}

}  // namespace attest::mc_att_control
