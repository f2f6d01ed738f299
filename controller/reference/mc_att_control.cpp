#include "controller/reference/mc_att_control.hpp"

#include <cmath>

#include "controller/reference/inline.hpp"

namespace attest::reference {
namespace {

// A step is taken to last between 2 ms and 20 ms, whatever the timestamps say.
constexpr float shortest_step_s = 0.002f;
constexpr float longest_step_s = 0.02f;

// Acro leaves the mixer some room above the throttle stick.
constexpr float acro_thrust_max = 0.9f;

constexpr std::uint32_t latched_on_demand =
    ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT | ATTEST_UPDATED_VEHICLE_RATES_SETPOINT;

float finite_or_zero(float value) { return std::isfinite(value) ? value : 0.0f; }

}  // namespace

template <typename Scalar>
McAttControl<Scalar>::McAttControl(Profile profile)
    : profile_(profile),
      parameters_(default_parameters()),
      gains_(compute_gains<Scalar>(parameters_)),
      attitude_(profile),
      rate_(profile) {}

template <typename Scalar>
bool McAttControl<Scalar>::set_parameter(std::string_view name, float value) {
  return reference::set_parameter(parameters_, name, value);
}

template <typename Scalar>
void McAttControl<Scalar>::step(const attest_inputs& in, attest_outputs& out) {
  out.vehicle_rates_setpoint.published = 0;
  out.actuator_controls_0.published = 0;
  out.mc_att_ctrl_status.published = 0;

  const Scalar dt_s = advance_clock(in.timestamp);
  latch_topics(in);
  apply_rattitude();
  const RateCommand<Scalar> command = outer_loop(in, out);
  if (topics_.mode.flag_control_rates_enabled != 0) inner_loop(in, command, dt_s, out);
}

template <typename Scalar>
ATTEST_INLINE Scalar McAttControl<Scalar>::advance_clock(std::uint64_t timestamp_us) {
  const Scalar dt_s = Scalar(timestamp_us - last_timestamp_us_) / Scalar(1000000);
  last_timestamp_us_ = timestamp_us;
  return clamp(dt_s, Scalar(shortest_step_s), Scalar(longest_step_s));
}

template <typename Scalar>
ATTEST_INLINE void McAttControl<Scalar>::latch_topics(const attest_inputs& in) {
  const auto updated = [&in](std::uint32_t topic) { return (in.updated & topic) != 0; };
  pending_ |= in.updated & latched_on_demand;
  if (first_step_ || updated(ATTEST_UPDATED_PARAMETER_UPDATE)) apply_parameters();

  if (updated(ATTEST_UPDATED_MANUAL_CONTROL_SETPOINT)) topics_.manual = in.manual_control_setpoint;
  if (updated(ATTEST_UPDATED_VEHICLE_CONTROL_MODE)) topics_.mode = in.vehicle_control_mode;
  if (updated(ATTEST_UPDATED_ACTUATOR_ARMED)) topics_.armed = in.actuator_armed.armed != 0;
  if (updated(ATTEST_UPDATED_BATTERY_STATUS)) topics_.battery_scale = in.battery_status.scale;
  if (updated(ATTEST_UPDATED_VEHICLE_STATUS)) {
    topics_.is_rotary_wing = in.vehicle_status.is_rotary_wing != 0;
    status_seen_ = true;
  }
  if (updated(ATTEST_UPDATED_MULTIROTOR_MOTOR_LIMITS)) {
    const auto& limits = in.multirotor_motor_limits;
    topics_.limits = {limits.lower_limit != 0, limits.upper_limit != 0, limits.yaw != 0};
  }
}

template <typename Scalar>
ATTEST_INLINE bool McAttControl<Scalar>::take_pending(std::uint32_t topic) {
  const bool was_pending = (pending_ & topic) != 0;
  pending_ &= ~topic;
  return was_pending;
}

template <typename Scalar>
void McAttControl<Scalar>::apply_parameters() {
  gains_ = compute_gains<Scalar>(parameters_);
  attitude_.set_gains(gains_.attitude);
  rate_.set_gains(gains_.rate);
  recovery_.set_gains(gains_.attitude);
  if (first_step_) {
    recovery_enabled_ = parameters_.vt_type == 0.0f && parameters_.vt_opt_recov_en != 0.0f;
    first_step_ = false;
  }
}

// Clears the flag in the latched copy: it stays cleared until vehicle_control_mode is updated,
// also when the stick comes back.
template <typename Scalar>
ATTEST_INLINE void McAttControl<Scalar>::apply_rattitude() {
  if (topics_.mode.flag_control_rattitude_enabled == 0) return;
  const bool rolling = std::abs(Scalar(topics_.manual.y)) > gains_.rattitude_threshold;
  const bool pitching = std::abs(Scalar(topics_.manual.x)) > gains_.rattitude_threshold;
  if (rolling || pitching) topics_.mode.flag_control_attitude_enabled = 0;
}

template <typename Scalar>
ATTEST_INLINE RateCommand<Scalar> McAttControl<Scalar>::outer_loop(const attest_inputs& in,
                                                                   attest_outputs& out) {
  const bool attitude = topics_.mode.flag_control_attitude_enabled != 0;
  const bool manual = topics_.mode.flag_control_manual_enabled != 0;
  if (!attitude && !manual) return follow_rates_setpoint(in);
  const RateCommand<Scalar> command = attitude ? control_attitude(in) : control_acro();
  publish_rates_setpoint(command, out);
  return command;
}

template <typename Scalar>
ATTEST_INLINE RateCommand<Scalar> McAttControl<Scalar>::control_attitude(const attest_inputs& in) {
  if (take_pending(ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT)) {
    topics_.attitude_setpoint = in.vehicle_attitude_setpoint;
  }
  const auto& setpoint = topics_.attitude_setpoint;
  const auto& mode = topics_.mode;
  const Quaternion<Scalar> q_WB = quaternion_from<Scalar>(in.control_state.q);
  const Quaternion<Scalar> q_WD = quaternion_from<Scalar>(setpoint.q_d);
  const Scalar move_rate = Scalar(setpoint.yaw_sp_move_rate);
  const Scalar thrust_sp = Scalar(setpoint.thrust);
  if (recovery_enabled_) return {recovery_.update(q_WB, q_WD, move_rate), thrust_sp};

  const bool by_vehicle = mode.flag_control_velocity_enabled != 0 ||
                          (profile_ == Profile::px4_v1_5_5 && mode.flag_control_auto_enabled != 0);
  const bool autonomous = by_vehicle && mode.flag_control_manual_enabled == 0;
  const bool weathervane = autonomous && setpoint.disable_mc_yaw_control != 0;
  if (weathervane) rate_.reset_yaw_integral();
  return {attitude_.update({q_WB, q_WD, move_rate, autonomous, weathervane}), thrust_sp};
}

template <typename Scalar>
ATTEST_INLINE RateCommand<Scalar> McAttControl<Scalar>::control_acro() const {
  const auto& manual = topics_.manual;
  const Vector3<Scalar> sticks(Scalar(manual.y), Scalar(-manual.x), Scalar(manual.r));
  // Written so that a NaN throttle gives the maximum.
  const float thrust_sp = manual.z < acro_thrust_max ? manual.z : acro_thrust_max;
  return {sticks.cwiseProduct(gains_.acro_rate_max_rad_s), Scalar(thrust_sp)};
}

template <typename Scalar>
ATTEST_INLINE RateCommand<Scalar> McAttControl<Scalar>::follow_rates_setpoint(
    const attest_inputs& in) {
  if (take_pending(ATTEST_UPDATED_VEHICLE_RATES_SETPOINT)) {
    topics_.rates_setpoint = in.vehicle_rates_setpoint;
  }
  const auto& setpoint = topics_.rates_setpoint;
  return {Vector3<Scalar>(Scalar(setpoint.roll), Scalar(setpoint.pitch), Scalar(setpoint.yaw)),
          Scalar(setpoint.thrust)};
}

template <typename Scalar>
ATTEST_INLINE void McAttControl<Scalar>::publish_rates_setpoint(const RateCommand<Scalar>& command,
                                                                attest_outputs& out) {
  const Vector3<Scalar>& rates_sp = command.rates_sp_B;
  topics_.rates_setpoint = {float(rates_sp[0]), float(rates_sp[1]), float(rates_sp[2]),
                            float(command.thrust_sp)};
  if (!status_seen_) return;
  const auto& setpoint = topics_.rates_setpoint;
  out.vehicle_rates_setpoint = {setpoint.roll, setpoint.pitch, setpoint.yaw, setpoint.thrust, 1};
  // The own sample is now the latest on the topic: one from outside is no longer waiting.
  take_pending(ATTEST_UPDATED_VEHICLE_RATES_SETPOINT);
}

template <typename Scalar>
ATTEST_INLINE void McAttControl<Scalar>::inner_loop(const attest_inputs& in,
                                                    const RateCommand<Scalar>& command, Scalar dt_s,
                                                    attest_outputs& out) {
  const auto& state = in.control_state;
  RateInput<Scalar> input;
  input.rates_B =
      Vector3<Scalar>(Scalar(state.roll_rate), Scalar(state.pitch_rate), Scalar(state.yaw_rate));
  input.rates_sp_B = command.rates_sp_B;
  input.thrust_sp = command.thrust_sp;
  input.published_thrust_sp = Scalar(topics_.rates_setpoint.thrust);
  input.dt_s = dt_s;
  input.limits = topics_.limits;
  input.flying = topics_.armed && topics_.is_rotary_wing;
  const Vector3<Scalar> control = rate_.update(input);
  if (status_seen_ && !gains_.actuators_cut) publish_actuators(control, command.thrust_sp, out);
  publish_status(out);
}

template <typename Scalar>
ATTEST_INLINE void McAttControl<Scalar>::publish_actuators(const Vector3<Scalar>& control,
                                                           Scalar thrust_sp,
                                                           attest_outputs& out) const {
  const bool v1_5_5 = profile_ == Profile::px4_v1_5_5;
  auto& actuators = out.actuator_controls_0;
  for (int i = 0; i < 3; ++i) actuators.control[i] = finite_or_zero(float(control[i]));
  actuators.control[3] = finite_or_zero(float(thrust_sp));
  for (int i = 4; i < 8; ++i) actuators.control[i] = 0.0f;
  if (v1_5_5) actuators.control[7] = topics_.attitude_setpoint.landing_gear;
  if (v1_5_5 && gains_.battery_scaling && topics_.battery_scale > 0.0f) {
    for (int i = 0; i < 4; ++i) actuators.control[i] *= topics_.battery_scale;
  }
  actuators.published = 1;
}

template <typename Scalar>
ATTEST_INLINE void McAttControl<Scalar>::publish_status(attest_outputs& out) const {
  const Vector3<Scalar>& integral = rate_.integral();
  out.mc_att_ctrl_status = {float(integral[0]), float(integral[1]), float(integral[2]), 1};
}

template class McAttControl<float>;
template class McAttControl<double>;

}  // namespace attest::reference
