#include "harness/casefile/baseline.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

namespace attest {
namespace {

enum class Of { every_module, controller, cascade, laws };

struct Row {
  std::string_view name;
  double value;
  std::optional<double> of_hover = {};
  Of of = Of::every_module;  // that has a channel of this name
};

// Channels that are not listed are zero. The setpoints of the cascade come from outside, as in a
// mission. The controller's thrust is positive upwards, the cascade's along body z, which points
// down.
constexpr Row rows[] = {
    {"in/control_state.q[0]", 1},
    {"in/vehicle_attitude.q[0]", 1},
    {"in/vehicle_attitude.delta_q_reset[0]", 1},
    {"in/vehicle_attitude_setpoint.q_d[0]", 1},
    {"in/vehicle_attitude_setpoint.thrust", 0.5, 1},
    {"in/vehicle_attitude_setpoint.thrust_body[2]", -0.5, -1},
    {"in/vehicle_rates_setpoint.thrust", 0, 1, Of::controller},
    {"in/vehicle_rates_setpoint.thrust_body[2]", -0.5, -1},
    {"in/manual_control_setpoint.z", 0.5, 1},
    {"in/battery_status.scale", 1},
    {"in/battery_status.connected", 1},
    {"in/actuator_armed.armed", 1},
    {"in/vehicle_status.armed", 1},
    {"in/vehicle_status.is_rotary_wing", 1},
    {"in/vehicle_local_position.unaided_heading", std::numeric_limits<double>::quiet_NaN()},
    {"in/vehicle_local_position.heading_good_for_control", 1},
    {"in/vehicle_control_mode.flag_armed", 1},
    {"in/vehicle_control_mode.flag_control_manual_enabled", 1, {}, Of::controller},
    {"in/vehicle_control_mode.flag_control_altitude_enabled", 1},
    {"in/vehicle_control_mode.flag_control_velocity_enabled", 1, {}, Of::cascade},
    {"in/vehicle_control_mode.flag_control_position_enabled", 1},
    {"in/vehicle_control_mode.flag_control_attitude_enabled", 1},
    {"in/vehicle_control_mode.flag_control_rates_enabled", 1},
    {"in/vehicle_control_mode.flag_control_rattitude_enabled", 1},
    {"in/control_allocator_status.torque_setpoint_achieved", 1},
    {"in/actuator_controls_0.control[3]", 0.5},
    {"in/battery.voltage_v", 12.15},
    {"in/battery.throttle", 0.5},
    {"in/battery.armed", 1},
    // Gains of the pure laws: the defaults of v1.16.0 and v1.18, those of the old laws of v1.5.5. A
    // limit is far from the rates of small errors.
    {"in/attitude_gains.p[0]", 6.5},
    {"in/attitude_gains.p[1]", 6.5},
    {"in/attitude_gains.p[2]", 2.8},
    {"in/attitude_gains.rate_max[0]", 3.84},
    {"in/attitude_gains.rate_max[1]", 3.84},
    {"in/attitude_gains.rate_max[2]", 3.49},
    {"in/attitude_gains.yaw_weight", 0.4},
    {"in/attitude_gains.yaw_ff", 0.5},
    {"in/attitude_gains.weathervane_scale", 0.15},
    {"in/attitude_gains.ref_w_n", 50},
    {"in/attitude_gains.ref_ff_max", 1.75},
    {"in/rate_gains.p[0]", 0.15},
    {"in/rate_gains.p[1]", 0.15},
    {"in/rate_gains.p[2]", 0.2},
    {"in/rate_gains.i[0]", 0.2},
    {"in/rate_gains.i[1]", 0.2},
    {"in/rate_gains.i[2]", 0.1},
    {"in/rate_gains.d[0]", 0.003},
    {"in/rate_gains.d[1]", 0.003},
    {"in/rate_gains.integral_max[0]", 0.3},
    {"in/rate_gains.integral_max[1]", 0.3},
    {"in/rate_gains.integral_max[2]", 0.3},
    {"in/rate_gains.tpa_break", 1},
    {"in/law.dt", 0.004},
    {"in/vehicle_rates_setpoint.thrust", 0.5, {}, Of::laws},
};

Of kind_of(const ModuleInfo& info) {
  if (info.is_law()) return Of::laws;
  return info.is_of_cascade() ? Of::cascade : Of::controller;
}

Row row_of(const Channel& channel) {
  const Of kind = kind_of(info_of(channel.module));
  const auto* const found = std::find_if(std::begin(rows), std::end(rows), [&](const Row& row) {
    return row.name == channel.name && (row.of == Of::every_module || row.of == kind);
  });
  return found == std::end(rows) ? Row{channel.name, 0} : *found;
}

}  // namespace

double baseline(const Channel& channel) { return row_of(channel).value; }

double baseline_in_flight(const Channel& channel) {
  return channel.name == "in/vehicle_status.armed_time" ? -5 : baseline(channel);
}

std::optional<double> baseline_of_hover(const Channel& channel) { return row_of(channel).of_hover; }

Sample baseline_sample(Module module) {
  Sample sample;
  for (const Channel& channel : channels()) {
    const bool is_field =
        channel.module == module && !channel.is_output() && channel.type != ChannelType::bit;
    if (is_field) set_value(channel, sample, baseline(channel));
  }
  return sample;
}

}  // namespace attest
