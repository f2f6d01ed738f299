#include "harness/casefile/baseline.hpp"

#include <limits>
#include <map>

namespace attest {
namespace {

// Channels that are not listed are zero.
double controller_baseline(std::string_view name) {
  static const std::map<std::string_view, double> values = {
      {"in/control_state.q[0]", 1},
      {"in/vehicle_attitude_setpoint.q_d[0]", 1},
      {"in/vehicle_attitude_setpoint.thrust", 0.5},
      {"in/manual_control_setpoint.z", 0.5},
      {"in/battery_status.scale", 1},
      {"in/actuator_armed.armed", 1},
      {"in/vehicle_status.is_rotary_wing", 1},
      {"in/vehicle_control_mode.flag_control_manual_enabled", 1},
      {"in/vehicle_control_mode.flag_control_rates_enabled", 1},
      {"in/vehicle_control_mode.flag_control_attitude_enabled", 1},
      {"in/vehicle_control_mode.flag_control_rattitude_enabled", 1},
      {"in/actuator_controls_0.control[3]", 0.5},
      {"in/battery.voltage_v", 12.15},
      {"in/battery.throttle", 0.5},
      {"in/battery.armed", 1},
  };
  const auto found = values.find(name);
  return found == values.end() ? 0 : found->second;
}

// The same for the units of the cascade. The setpoints come from outside, as in a mission.
double cascade_baseline(std::string_view name) {
  static const std::map<std::string_view, double> values = {
      {"in/vehicle_attitude.q[0]", 1},
      {"in/vehicle_attitude.delta_q_reset[0]", 1},
      {"in/vehicle_attitude_setpoint.q_d[0]", 1},
      {"in/vehicle_attitude_setpoint.thrust_body[2]", -0.5},
      {"in/vehicle_rates_setpoint.thrust_body[2]", -0.5},
      {"in/vehicle_status.armed", 1},
      {"in/vehicle_status.is_rotary_wing", 1},
      {"in/vehicle_local_position.unaided_heading", std::numeric_limits<double>::quiet_NaN()},
      {"in/vehicle_local_position.heading_good_for_control", 1},
      {"in/vehicle_control_mode.flag_armed", 1},
      {"in/vehicle_control_mode.flag_control_altitude_enabled", 1},
      {"in/vehicle_control_mode.flag_control_velocity_enabled", 1},
      {"in/vehicle_control_mode.flag_control_position_enabled", 1},
      {"in/vehicle_control_mode.flag_control_attitude_enabled", 1},
      {"in/vehicle_control_mode.flag_control_rates_enabled", 1},
      {"in/control_allocator_status.torque_setpoint_achieved", 1},
      {"in/battery_status.scale", 1},
      {"in/battery_status.connected", 1},
  };
  const auto found = values.find(name);
  return found == values.end() ? 0 : found->second;
}

}  // namespace

double baseline(const Channel& channel) {
  const bool is_cascade =
      channel.module == Module::attitude_unit || channel.module == Module::rate_unit;
  return is_cascade ? cascade_baseline(channel.name) : controller_baseline(channel.name);
}

double baseline_in_flight(const Channel& channel) {
  return channel.name == "in/vehicle_status.armed_time" ? -5 : baseline(channel);
}

std::optional<double> baseline_of_hover(const Channel& channel) {
  // The controller's thrust is positive upwards, the cascade's along body z, which points down.
  const auto is = [&](Module module, std::string_view name) {
    return channel.module == module && channel.name == name;
  };
  if (is(Module::mc_att_control, "in/vehicle_attitude_setpoint.thrust") ||
      is(Module::mc_att_control, "in/vehicle_rates_setpoint.thrust") ||
      is(Module::mc_att_control, "in/manual_control_setpoint.z")) {
    return 1;
  }
  if (is(Module::attitude_unit, "in/vehicle_attitude_setpoint.thrust_body[2]") ||
      is(Module::rate_unit, "in/vehicle_rates_setpoint.thrust_body[2]")) {
    return -1;
  }
  return std::nullopt;
}

}  // namespace attest
