#include <iterator>

#include "harness/trace/module_table.hpp"

namespace attest {
namespace {

static_assert(offsetof(attest_attitude_inputs, updated) == offsetof(attest_inputs, updated) &&
              offsetof(attest_rate_inputs, updated) == offsetof(attest_inputs, updated));

constexpr Channel number(std::string_view name, Quantity quantity, Module module, Stage stage,
                         std::size_t offset) {
  return {name, ChannelType::f32, quantity, module, stage, offset, 0};
}

constexpr Channel flag(std::string_view name, Module module, Stage stage, std::size_t offset) {
  return {name, ChannelType::u8, Quantity::flag, module, stage, offset, 0};
}

// All units have `updated` at the same place.
constexpr Channel updated(std::string_view name, Module module, int mask) {
  return {name,
          ChannelType::bit,
          Quantity::flag,
          module,
          Stage::input,
          offsetof(Sample, in.updated),
          static_cast<std::uint32_t>(mask)};
}

constexpr Channel byte(std::string_view name, Module module, std::size_t offset) {
  return {name, ChannelType::u8, Quantity::count, module, Stage::input, offset, 0};
}

constexpr Channel time(std::string_view name, Module module, std::size_t offset) {
  return {name, ChannelType::u64, Quantity::time, module, Stage::input, offset, 0};
}

// MODULE is the module of the rows that follow; INPUTS and OUTPUTS are its members of Sample. Each
// macro makes a channel with the name "in/member" or "out/member" and the offset of that member.
#define IN(member, quantity)                                              \
  number("in/" #member, Quantity::quantity, Module::MODULE, Stage::input, \
         offsetof(Sample, INPUTS.member))
#define IN_3(member, quantity) \
  IN(member[0], quantity), IN(member[1], quantity), IN(member[2], quantity)
#define IN_4(member, quantity) IN_3(member, quantity), IN(member[3], quantity)
#define FLAG(member) \
  flag("in/" #member, Module::MODULE, Stage::input, offsetof(Sample, INPUTS.member))
#define BYTE(member) byte("in/" #member, Module::MODULE, offsetof(Sample, INPUTS.member))
#define TIME(member) time("in/" #member, Module::MODULE, offsetof(Sample, INPUTS.member))
#define UPDATED(topic, mask) updated("in/updated." #topic, Module::MODULE, mask)
#define OUT(member, quantity, stage)                                       \
  number("out/" #member, Quantity::quantity, Module::MODULE, Stage::stage, \
         offsetof(Sample, OUTPUTS.member))
#define OUT_3(member, quantity, stage) \
  OUT(member[0], quantity, stage), OUT(member[1], quantity, stage), OUT(member[2], quantity, stage)
#define OUT_4(member, quantity, stage) \
  OUT_3(member, quantity, stage), OUT(member[3], quantity, stage)
#define OUT_FLAG(member, stage) \
  flag("out/" #member, Module::MODULE, Stage::stage, offsetof(Sample, OUTPUTS.member))
#define PUBLISHED(topic, stage) OUT_FLAG(topic.published, stage)

constexpr Channel channel_rows[] = {
#define MODULE mc_att_control
#define INPUTS in
#define OUTPUTS out
    time("timestamp", Module::mc_att_control, offsetof(Sample, in.timestamp)),  // of every module
    IN_4(control_state.q, quaternion),
    IN(control_state.roll_rate, rate),
    IN(control_state.pitch_rate, rate),
    IN(control_state.yaw_rate, rate),
    IN_4(vehicle_attitude_setpoint.q_d, quaternion),
    IN(vehicle_attitude_setpoint.thrust, thrust),
    IN(vehicle_attitude_setpoint.yaw_sp_move_rate, rate),
    FLAG(vehicle_attitude_setpoint.disable_mc_yaw_control),
    IN(vehicle_attitude_setpoint.landing_gear, control),
    IN(vehicle_rates_setpoint.roll, rate),
    IN(vehicle_rates_setpoint.pitch, rate),
    IN(vehicle_rates_setpoint.yaw, rate),
    IN(vehicle_rates_setpoint.thrust, thrust),
    IN(manual_control_setpoint.x, stick),
    IN(manual_control_setpoint.y, stick),
    IN(manual_control_setpoint.z, stick),
    IN(manual_control_setpoint.r, stick),
    FLAG(vehicle_control_mode.flag_control_manual_enabled),
    FLAG(vehicle_control_mode.flag_control_auto_enabled),
    FLAG(vehicle_control_mode.flag_control_rates_enabled),
    FLAG(vehicle_control_mode.flag_control_attitude_enabled),
    FLAG(vehicle_control_mode.flag_control_rattitude_enabled),
    FLAG(vehicle_control_mode.flag_control_velocity_enabled),
    FLAG(actuator_armed.armed),
    FLAG(vehicle_status.is_rotary_wing),
    FLAG(vehicle_status.is_vtol),
    FLAG(multirotor_motor_limits.lower_limit),
    FLAG(multirotor_motor_limits.upper_limit),
    FLAG(multirotor_motor_limits.yaw),
    IN(battery_status.scale, scale),
    UPDATED(vehicle_attitude_setpoint, ATTEST_UPDATED_VEHICLE_ATTITUDE_SETPOINT),
    UPDATED(vehicle_rates_setpoint, ATTEST_UPDATED_VEHICLE_RATES_SETPOINT),
    UPDATED(manual_control_setpoint, ATTEST_UPDATED_MANUAL_CONTROL_SETPOINT),
    UPDATED(vehicle_control_mode, ATTEST_UPDATED_VEHICLE_CONTROL_MODE),
    UPDATED(actuator_armed, ATTEST_UPDATED_ACTUATOR_ARMED),
    UPDATED(vehicle_status, ATTEST_UPDATED_VEHICLE_STATUS),
    UPDATED(multirotor_motor_limits, ATTEST_UPDATED_MULTIROTOR_MOTOR_LIMITS),
    UPDATED(battery_status, ATTEST_UPDATED_BATTERY_STATUS),
    UPDATED(parameter_update, ATTEST_UPDATED_PARAMETER_UPDATE),
    PUBLISHED(vehicle_rates_setpoint, attitude_law),
    OUT(vehicle_rates_setpoint.roll, rate, attitude_law),
    OUT(vehicle_rates_setpoint.pitch, rate, attitude_law),
    OUT(vehicle_rates_setpoint.yaw, rate, attitude_law),
    OUT(vehicle_rates_setpoint.thrust, thrust, attitude_law),
    PUBLISHED(actuator_controls_0, actuators),
    OUT_3(actuator_controls_0.control, control, rate_law),
    OUT(actuator_controls_0.control[3], control, actuators),
    OUT(actuator_controls_0.control[4], control, actuators),
    OUT(actuator_controls_0.control[5], control, actuators),
    OUT(actuator_controls_0.control[6], control, actuators),
    OUT(actuator_controls_0.control[7], control, actuators),
    PUBLISHED(mc_att_ctrl_status, integrator),
    OUT(mc_att_ctrl_status.roll_rate_integ, integral, integrator),
    OUT(mc_att_ctrl_status.pitch_rate_integ, integral, integrator),
    OUT(mc_att_ctrl_status.yaw_rate_integ, integral, integrator),
#undef MODULE
#undef INPUTS
#undef OUTPUTS

#define MODULE mixer
#define INPUTS mixer_in
#define OUTPUTS mixer_out
    IN_3(actuator_controls_0.control, control),
    IN(actuator_controls_0.control[3], thrust),
    IN(mixer.delta_out_max, motor),
    OUT_4(actuator_outputs.output, motor, mixer),
    OUT(actuator_outputs.output[4], motor, mixer),
    OUT(actuator_outputs.output[5], motor, mixer),
    OUT(actuator_outputs.output[6], motor, mixer),
    OUT(actuator_outputs.output[7], motor, mixer),
    OUT_FLAG(multirotor_motor_limits.lower_limit, mixer),
    OUT_FLAG(multirotor_motor_limits.upper_limit, mixer),
    OUT_FLAG(multirotor_motor_limits.yaw, mixer),
#undef MODULE
#undef INPUTS
#undef OUTPUTS

#define MODULE battery_status
#define INPUTS battery_in
#define OUTPUTS battery_out
    IN(battery.voltage_v, voltage),
    IN(battery.current_a, current),
    IN(battery.throttle, thrust),
    FLAG(battery.armed),
    OUT(battery_status.scale, scale, battery_status),
#undef MODULE
#undef INPUTS
#undef OUTPUTS

#define MODULE attitude_unit
#define INPUTS attitude_in
#define OUTPUTS attitude_out
    TIME(vehicle_attitude.timestamp),
    TIME(vehicle_attitude.timestamp_sample),
    IN_4(vehicle_attitude.q, quaternion),
    IN_4(vehicle_attitude.delta_q_reset, quaternion),
    BYTE(vehicle_attitude.quat_reset_counter),
    TIME(vehicle_attitude_setpoint.timestamp),
    IN_4(vehicle_attitude_setpoint.q_d, quaternion),
    IN_3(vehicle_attitude_setpoint.thrust_body, thrust),
    IN(vehicle_attitude_setpoint.yaw_sp_move_rate, rate),
    IN(manual_control_setpoint.roll, stick),
    IN(manual_control_setpoint.pitch, stick),
    IN(manual_control_setpoint.yaw, stick),
    IN(manual_control_setpoint.throttle, stick),
    FLAG(vehicle_control_mode.flag_control_manual_enabled),
    FLAG(vehicle_control_mode.flag_control_altitude_enabled),
    FLAG(vehicle_control_mode.flag_control_velocity_enabled),
    FLAG(vehicle_control_mode.flag_control_position_enabled),
    FLAG(vehicle_control_mode.flag_control_attitude_enabled),
    TIME(vehicle_status.armed_time),
    FLAG(vehicle_status.armed),
    FLAG(vehicle_status.is_rotary_wing),
    FLAG(vehicle_status.is_vtol),
    FLAG(vehicle_status.in_transition_mode),
    FLAG(vehicle_status.is_vtol_tailsitter),
    FLAG(vehicle_land_detected.landed),
    IN(vehicle_local_position.unaided_heading, angle),
    FLAG(vehicle_local_position.heading_good_for_control),
    IN(hover_thrust_estimate.hover_thrust, thrust),
    FLAG(hover_thrust_estimate.valid),
    TIME(autotune_attitude_control_status.timestamp),
    IN_3(autotune_attitude_control_status.rate_sp, rate),
    BYTE(autotune_attitude_control_status.state),
    UPDATED(vehicle_attitude_setpoint, ATTEST_ATTITUDE_UPDATED_VEHICLE_ATTITUDE_SETPOINT),
    UPDATED(manual_control_setpoint, ATTEST_ATTITUDE_UPDATED_MANUAL_CONTROL_SETPOINT),
    UPDATED(vehicle_control_mode, ATTEST_ATTITUDE_UPDATED_VEHICLE_CONTROL_MODE),
    UPDATED(vehicle_status, ATTEST_ATTITUDE_UPDATED_VEHICLE_STATUS),
    UPDATED(vehicle_land_detected, ATTEST_ATTITUDE_UPDATED_VEHICLE_LAND_DETECTED),
    UPDATED(vehicle_local_position, ATTEST_ATTITUDE_UPDATED_VEHICLE_LOCAL_POSITION),
    UPDATED(hover_thrust_estimate, ATTEST_ATTITUDE_UPDATED_HOVER_THRUST_ESTIMATE),
    UPDATED(autotune_attitude_control_status,
            ATTEST_ATTITUDE_UPDATED_AUTOTUNE_ATTITUDE_CONTROL_STATUS),
    UPDATED(parameter_update, ATTEST_ATTITUDE_UPDATED_PARAMETER_UPDATE),
    OUT(vehicle_rates_setpoint.roll, rate, attitude_law),
    OUT(vehicle_rates_setpoint.pitch, rate, attitude_law),
    OUT(vehicle_rates_setpoint.yaw, rate, attitude_law),
    OUT_3(vehicle_rates_setpoint.thrust_body, control, attitude_law),
    PUBLISHED(vehicle_rates_setpoint, attitude_law),
    OUT_4(vehicle_attitude_setpoint.q_d, quaternion, sticks),
    OUT_3(vehicle_attitude_setpoint.thrust_body, control, sticks),
    OUT(vehicle_attitude_setpoint.yaw_sp_move_rate, rate, sticks),
    PUBLISHED(vehicle_attitude_setpoint, sticks),
#undef MODULE
#undef INPUTS
#undef OUTPUTS

#define MODULE rate_unit
#define INPUTS rate_in
#define OUTPUTS rate_out
    TIME(vehicle_angular_velocity.timestamp_sample),
    IN_3(vehicle_angular_velocity.xyz, rate),
    IN_3(vehicle_angular_velocity.xyz_derivative, angular_acceleration),
    IN(vehicle_rates_setpoint.roll, rate),
    IN(vehicle_rates_setpoint.pitch, rate),
    IN(vehicle_rates_setpoint.yaw, rate),
    IN_3(vehicle_rates_setpoint.thrust_body, thrust),
    IN(manual_control_setpoint.roll, stick),
    IN(manual_control_setpoint.pitch, stick),
    IN(manual_control_setpoint.yaw, stick),
    IN(manual_control_setpoint.throttle, stick),
    IN_3(control_allocator_status.unallocated_torque, control),
    FLAG(control_allocator_status.torque_setpoint_achieved),
    IN(battery_status.scale, scale),
    FLAG(battery_status.connected),
    FLAG(vehicle_control_mode.flag_armed),
    FLAG(vehicle_control_mode.flag_control_manual_enabled),
    FLAG(vehicle_control_mode.flag_control_attitude_enabled),
    FLAG(vehicle_control_mode.flag_control_rates_enabled),
    FLAG(vehicle_status.is_rotary_wing),
    FLAG(vehicle_land_detected.maybe_landed),
    FLAG(vehicle_land_detected.landed),
    UPDATED(vehicle_rates_setpoint, ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT),
    UPDATED(manual_control_setpoint, ATTEST_RATE_UPDATED_MANUAL_CONTROL_SETPOINT),
    UPDATED(vehicle_control_mode, ATTEST_RATE_UPDATED_VEHICLE_CONTROL_MODE),
    UPDATED(vehicle_status, ATTEST_RATE_UPDATED_VEHICLE_STATUS),
    UPDATED(vehicle_land_detected, ATTEST_RATE_UPDATED_VEHICLE_LAND_DETECTED),
    UPDATED(control_allocator_status, ATTEST_RATE_UPDATED_CONTROL_ALLOCATOR_STATUS),
    UPDATED(battery_status, ATTEST_RATE_UPDATED_BATTERY_STATUS),
    UPDATED(parameter_update, ATTEST_RATE_UPDATED_PARAMETER_UPDATE),
    OUT_3(vehicle_torque_setpoint.xyz, control, rate_law),
    PUBLISHED(vehicle_torque_setpoint, rate_law),
    OUT_3(vehicle_thrust_setpoint.xyz, thrust, actuators),
    PUBLISHED(vehicle_thrust_setpoint, actuators),
    OUT(rate_ctrl_status.rollspeed_integ, integral, integrator),
    OUT(rate_ctrl_status.pitchspeed_integ, integral, integrator),
    OUT(rate_ctrl_status.yawspeed_integ, integral, integrator),
    PUBLISHED(rate_ctrl_status, integrator),
    OUT(vehicle_rates_setpoint.roll, rate, sticks),
    OUT(vehicle_rates_setpoint.pitch, rate, sticks),
    OUT(vehicle_rates_setpoint.yaw, rate, sticks),
    OUT_3(vehicle_rates_setpoint.thrust_body, thrust, sticks),
    PUBLISHED(vehicle_rates_setpoint, sticks),
#undef MODULE
#undef INPUTS
#undef OUTPUTS

#define MODULE attitude_law
#define INPUTS attitude_law.in
#define OUTPUTS attitude_law_out
    IN_4(vehicle_attitude.q, quaternion),
    TIME(vehicle_attitude_setpoint.timestamp),
    IN_4(vehicle_attitude_setpoint.q_d, quaternion),
    IN(vehicle_attitude_setpoint.yaw_sp_move_rate, rate),
    IN_3(attitude_gains.p, scale),
    IN_3(attitude_gains.rate_max, rate),
    IN(attitude_gains.yaw_weight, scale),
    IN(attitude_gains.yaw_ff, scale),
    IN(attitude_gains.weathervane_scale, scale),
    IN(attitude_gains.ref_w_n, rate),
    IN(attitude_gains.ref_ff, scale),
    IN(attitude_gains.ref_ff_max, rate),
    FLAG(law.weathervane),
    OUT(vehicle_rates_setpoint.roll, rate, attitude_law),
    OUT(vehicle_rates_setpoint.pitch, rate, attitude_law),
    OUT(vehicle_rates_setpoint.yaw, rate, attitude_law),
#undef MODULE
#undef INPUTS
#undef OUTPUTS

#define MODULE rate_law
#define INPUTS rate_law.in
#define OUTPUTS rate_law_out
    IN_3(vehicle_angular_velocity.xyz, rate),
    IN_3(vehicle_angular_velocity.xyz_derivative, angular_acceleration),
    IN(vehicle_rates_setpoint.roll, rate),
    IN(vehicle_rates_setpoint.pitch, rate),
    IN(vehicle_rates_setpoint.yaw, rate),
    IN(vehicle_rates_setpoint.thrust, thrust),
    IN_3(previous.rates, rate),
    IN_3(previous.rates_sp, rate),
    IN_3(rate_gains.p, scale),
    IN_3(rate_gains.i, scale),
    IN_3(rate_gains.d, scale),
    IN_3(rate_gains.ff, scale),
    IN_3(rate_gains.integral_max, integral),
    IN(rate_gains.tpa_break, thrust),
    IN(rate_gains.tpa_slope, scale),
    IN(law.dt, duration),
    FLAG(law.landed),
    FLAG(law.reset),
    FLAG(saturation.positive[0]),
    FLAG(saturation.positive[1]),
    FLAG(saturation.positive[2]),
    FLAG(saturation.negative[0]),
    FLAG(saturation.negative[1]),
    FLAG(saturation.negative[2]),
    FLAG(multirotor_motor_limits.lower_limit),
    FLAG(multirotor_motor_limits.upper_limit),
    FLAG(multirotor_motor_limits.yaw),
    OUT_3(vehicle_torque_setpoint.xyz, control, rate_law),
    OUT(rate_ctrl_status.rollspeed_integ, integral, integrator),
    OUT(rate_ctrl_status.pitchspeed_integ, integral, integrator),
    OUT(rate_ctrl_status.yawspeed_integ, integral, integrator),
#undef MODULE
#undef INPUTS
#undef OUTPUTS
};
static_assert(std::size(channel_rows) <= max_channels);

#undef IN
#undef IN_3
#undef IN_4
#undef FLAG
#undef BYTE
#undef TIME
#undef UPDATED
#undef OUT
#undef OUT_3
#undef OUT_4
#undef OUT_FLAG
#undef PUBLISHED

}  // namespace

constinit const std::span<const Channel> channel_table = channel_rows;

}  // namespace attest
