// The definitions of RateUnit, for code that instantiates it with another law.
#pragma once

#include "controller/cascade/rate_unit.hpp"

namespace attest::cascade {

// Topics that are latched when the law uses them, which may be some steps after they arrive.
inline constexpr std::uint32_t latched_on_demand =
    ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT | ATTEST_RATE_UPDATED_MANUAL_CONTROL_SETPOINT |
    ATTEST_RATE_UPDATED_CONTROL_ALLOCATOR_STATUS | ATTEST_RATE_UPDATED_BATTERY_STATUS;

template <typename Scalar, typename Law>
RateUnit<Scalar, Law>::RateUnit(Profile profile, const Law& law)
    : profile_(profile),
      traits_(law.step.traits(profile)),
      parameters_(default_parameters(rate_parameters(), profile)),
      stages_(law.step),
      rate_(law.rate) {}

template <typename Scalar, typename Law>
bool RateUnit<Scalar, Law>::set_parameter(std::string_view name, float value) {
  return attest::set_parameter(parameters_, rate_parameters(), profile_, name, value);
}

template <typename Scalar, typename Law>
void RateUnit<Scalar, Law>::step(const attest_rate_inputs& in, attest_rate_outputs& out) {
  out.vehicle_torque_setpoint.published = 0;
  out.vehicle_thrust_setpoint.published = 0;
  out.rate_ctrl_status.published = 0;
  out.vehicle_rates_setpoint.published = 0;
  if (first_step_ || (in.updated & ATTEST_RATE_UPDATED_PARAMETER_UPDATE) != 0) read_parameters();

  const std::uint64_t sample_us = in.vehicle_angular_velocity.timestamp_sample;
  const Scalar dt_s = stages_.step_time(sample_us, last_sample_us_);
  last_sample_us_ = sample_us;
  latch_topics(in);
  if (stages_.is_acro(topics_)) {
    follow_sticks(in, out);
  } else {
    follow_setpoint(in);
  }
  if (topics_.mode.flag_control_rates_enabled != 0) control_rates(in, dt_s, out);
}

template <typename Scalar, typename Law>
void RateUnit<Scalar, Law>::read_parameters() {
  first_step_ = false;
  gains_ = stages_.gains(parameters_);
  rate_.set_gains(gains_.rate);
}

template <typename Scalar, typename Law>
void RateUnit<Scalar, Law>::latch_topics(const attest_rate_inputs& in) {
  const auto updated = [&in](std::uint32_t topic) { return (in.updated & topic) != 0; };
  pending_ = stages_.pending(pending_, in.updated & latched_on_demand);
  if (updated(ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT)) {
    const auto& setpoint = in.vehicle_rates_setpoint;
    newest_setpoint_ = {{Scalar(setpoint.roll), Scalar(setpoint.pitch), Scalar(setpoint.yaw)},
                        vector_from<Scalar>(setpoint.thrust_body)};
  }
  if (updated(ATTEST_RATE_UPDATED_VEHICLE_CONTROL_MODE)) topics_.mode = in.vehicle_control_mode;
  if (updated(ATTEST_RATE_UPDATED_VEHICLE_LAND_DETECTED)) topics_.land = in.vehicle_land_detected;
  if (updated(ATTEST_RATE_UPDATED_VEHICLE_STATUS)) {
    topics_.is_rotary_wing = in.vehicle_status.is_rotary_wing != 0;
  }
}

template <typename Scalar, typename Law>
bool RateUnit<Scalar, Law>::take_pending(std::uint32_t topic) {
  const bool was_pending = (pending_ & topic) != 0;
  pending_ &= ~topic;
  return was_pending;
}

// Only a new stick sample makes a setpoint. Without one, the old setpoint stays.
template <typename Scalar, typename Law>
void RateUnit<Scalar, Law>::follow_sticks(const attest_rate_inputs& in, attest_rate_outputs& out) {
  if (!take_pending(ATTEST_RATE_UPDATED_MANUAL_CONTROL_SETPOINT)) return;
  setpoint_ = stages_.acro(in.manual_control_setpoint, gains_.acro);
  const Vector3<Scalar>& rates = setpoint_.rates_B;
  auto& topic = out.vehicle_rates_setpoint;
  topic.roll = float(rates[0]);
  topic.pitch = float(rates[1]);
  topic.yaw = float(rates[2]);
  for (int i = 0; i < 3; ++i) topic.thrust_body[i] = float(setpoint_.thrust_B[i]);
  topic.published = 1;
  const bool external = (pending_ & ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT) != 0;
  if (external && !stages_.supersedes_pending()) return;
  newest_setpoint_ = setpoint_;
  pending_ |= ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT;
}

template <typename Scalar, typename Law>
void RateUnit<Scalar, Law>::follow_setpoint(const attest_rate_inputs& in) {
  if (!take_pending(ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT)) return;
  setpoint_ = newest_setpoint_;
  const Vector3<Scalar> measured = vector_from<Scalar>(in.vehicle_angular_velocity.xyz);
  for (int i = 0; i < 3; ++i) {
    setpoint_.rates_B[i] = stages_.commanded(setpoint_.rates_B[i], measured[i]);
  }
}

template <typename Scalar, typename Law>
void RateUnit<Scalar, Law>::control_rates(const attest_rate_inputs& in, Scalar dt_s,
                                          attest_rate_outputs& out) {
  if (stages_.resets_integral(topics_)) rate_.reset_integral();
  if (take_pending(ATTEST_RATE_UPDATED_CONTROL_ALLOCATOR_STATUS)) {
    rate_.set_saturation(in.control_allocator_status);
  }
  const auto& gyro = in.vehicle_angular_velocity;
  Vector3<Scalar> torque = rate_.update({.rates_B = vector_from<Scalar>(gyro.xyz),
                                         .rates_sp_B = setpoint_.rates_B,
                                         .acceleration_B = vector_from<Scalar>(gyro.xyz_derivative),
                                         .dt_s = dt_s,
                                         .maybe_landed = topics_.land.maybe_landed != 0,
                                         .landed = topics_.land.landed != 0});
  if (traits_.filters_yaw_torque) {
    torque[2] = stages_.filtered_yaw(yaw_torque_, torque[2], dt_s, gains_, traits_);
  }
  publish_status(out);
  for (int i = 0; i < 3; ++i) torque[i] = stages_.guarded(torque[i]);
  Vector3<Scalar> thrust = setpoint_.thrust_B;
  if (gains_.battery_scaling) scale_by_battery(in, torque, thrust);
  for (int i = 0; i < 3; ++i) {
    out.vehicle_torque_setpoint.xyz[i] = float(torque[i]);
    out.vehicle_thrust_setpoint.xyz[i] = float(thrust[i]);
  }
  out.vehicle_torque_setpoint.published = 1;
  out.vehicle_thrust_setpoint.published = 1;
}

// Not called while scaling is off: battery samples then stay pending.
template <typename Scalar, typename Law>
void RateUnit<Scalar, Law>::scale_by_battery(const attest_rate_inputs& in, Vector3<Scalar>& torque,
                                             Vector3<Scalar>& thrust) {
  if (take_pending(ATTEST_RATE_UPDATED_BATTERY_STATUS)) {
    battery_scale_ = stages_.battery_scale(battery_scale_, in.battery_status);
  }
  if (!(battery_scale_ > Scalar(0))) return;
  for (int i = 0; i < 3; ++i) {
    torque[i] = stages_.scaled(torque[i], battery_scale_);
    thrust[i] = stages_.scaled(thrust[i], battery_scale_);
  }
}

template <typename Scalar, typename Law>
void RateUnit<Scalar, Law>::publish_status(attest_rate_outputs& out) const {
  const Vector3<Scalar>& integral = rate_.integral();
  out.rate_ctrl_status = {float(integral[0]), float(integral[1]), float(integral[2]), 1};
}

}  // namespace attest::cascade
