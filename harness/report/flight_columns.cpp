#include "harness/report/flight_columns.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>
#include <tuple>

#include "harness/compare/metric.hpp"
#include "harness/trace/plant_columns.hpp"

namespace attest {
namespace {

// The values of the column `name`: of a channel, or else of the plant.
std::vector<float> column(const Trace& flown, std::string_view name) {
  std::vector<float> values;
  if (const auto channel = find_channel(module_of(flown.present), name)) {
    for (const Sample& sample : flown.samples) {
      values.push_back(static_cast<float>(value_of(channels()[*channel], sample)));
    }
    return values;
  }
  const auto columns = plant_columns();
  const auto found = std::ranges::find(columns, name, &PlantColumn::name);
  for (const PlantSample& sample : flown.plant) values.push_back(found->value(sample));
  return values;
}

Quaternions quaternions(const Trace& flown, const std::string& name) {
  Quaternions out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = column(flown, name + "[" + std::to_string(i) + "]");
  }
  return out;
}

// Roll, pitch and yaw [deg] of the rotation from body to world. The intrinsic rotations are yaw,
// then pitch, then roll, as in the class Euler of PX4.
std::array<float, 3> euler_deg(float w, float x, float y, float z) {
  const float degrees = 180 / std::numbers::pi_v<float>;
  const float sin_pitch = std::clamp(2 * (w * y - z * x), -1.0f, 1.0f);
  return {degrees * std::atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
          degrees * std::asin(sin_pitch),
          degrees * std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))};
}

Columns columns_of(const Trace& flown, const NamedColumns& wanted) {
  Columns columns;
  for (const auto& [of, name] : wanted) columns.emplace_back(name, column(flown, of));
  return columns;
}

const Trace* attitude_of(const Flown& flown) {
  return flown.attitude_trace ? &*flown.attitude_trace : nullptr;
}

}  // namespace

ColumnsOf columns_named(NamedColumns wanted) {
  return
      [wanted = std::move(wanted)](const Flown& flown) { return columns_of(flown.trace, wanted); };
}

NamedColumns about_axes(const std::array<const char*, 3>& columns, const std::string& what) {
  return {{columns[0], "roll " + what}, {columns[1], "pitch " + what}, {columns[2], "yaw " + what}};
}

std::vector<double> seconds_of(const Trace& flown) {
  std::vector<double> out;
  for (const Sample& sample : flown.samples) {
    const std::uint64_t elapsed_us = sample.in.timestamp - flown.samples.front().in.timestamp;
    out.push_back(1e-6 * static_cast<double>(elapsed_us));
  }
  return out;
}

Quaternions attitudes_of(const Flown& flown) {
  return quaternions(flown.trace, "plant/vehicle_attitude.q");
}

Quaternions setpoints_of(const Flown& flown) {
  Quaternions out;
  for (const auto& q_d : attitude_setpoints(flown.trace, attitude_of(flown))) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i].push_back(q_d[i]);
  }
  return out;
}

// Without jumps of a whole turn, which would hide a small change about half a turn.
Columns angle_columns(const Quaternions& q, const std::string& of) {
  Columns columns = {{of + "roll", {}}, {of + "pitch", {}}, {of + "yaw", {}}};
  for (std::size_t tick = 0; tick < q[0].size(); ++tick) {
    const auto angles_deg = euler_deg(q[0][tick], q[1][tick], q[2][tick], q[3][tick]);
    for (std::size_t i = 0; i < 3; ++i) {
      std::vector<float>& angle = columns[i].second;
      const float before = angle.empty() ? 0 : angle.back();
      const float turns = std::round((angles_deg[i] - before) / 360);
      angle.push_back(angles_deg[i] - 360 * (std::isfinite(turns) ? turns : 0));
    }
  }
  return columns;
}

Columns attitude_error_column(const Flown& flown) {
  const auto errors = attitude_errors_deg(flown.trace, attitude_of(flown));
  return {{"attitude error", {errors.begin(), errors.end()}}};
}

Columns rate_length_column(const Flown& flown) {
  Columns column = {{"length", {}}};
  for (const PlantSample& sample : flown.trace.plant) {
    const auto& [roll, pitch, yaw] = sample.rate_rad_s;
    column.front().second.push_back(std::hypot(roll, pitch, yaw));
  }
  return column;
}

// The trace has the position in north, east, down.
Columns position_columns(const Flown& flown) {
  Columns columns = columns_of(flown.trace, {{"plant/vehicle_local_position.x", "north"},
                                             {"plant/vehicle_local_position.y", "east"},
                                             {"plant/vehicle_local_position.z", "altitude"}});
  for (float& down : columns.back().second) down = -down;
  return columns;
}

Columns motor_columns(const Flown& flight) {
  const Trace& flown = flight.trace;
  NamedColumns motors;
  for (std::size_t i = 0; i < std::tuple_size_v<decltype(PlantSample::motor)>; ++i) {
    const bool turns = std::any_of(flown.plant.begin(), flown.plant.end(),
                                   [i](const PlantSample& s) { return s.rotor_rad_s[i] != 0; });
    if (!turns && i > 0) continue;
    const std::string number = std::to_string(i);
    motors.push_back({"plant/actuator_outputs.output[" + number + "]", "motor " + number});
  }
  return columns_of(flown, motors);
}

LawColumns columns_of_law(Module module) {
  if (module == Module::rate_unit) {
    return {
        about_axes({"in/vehicle_rates_setpoint.roll", "in/vehicle_rates_setpoint.pitch",
                    "in/vehicle_rates_setpoint.yaw"},
                   "setpoint"),
        about_axes({"out/vehicle_torque_setpoint.xyz[0]", "out/vehicle_torque_setpoint.xyz[1]",
                    "out/vehicle_torque_setpoint.xyz[2]"},
                   "torque"),
        {{"out/vehicle_thrust_setpoint.xyz[2]", "thrust, down"}},
        about_axes({"out/rate_ctrl_status.rollspeed_integ", "out/rate_ctrl_status.pitchspeed_integ",
                    "out/rate_ctrl_status.yawspeed_integ"},
                   "integral"),
        "Torque setpoint",
        "Saturation of the allocator"};
  }
  return {about_axes({"out/vehicle_rates_setpoint.roll", "out/vehicle_rates_setpoint.pitch",
                      "out/vehicle_rates_setpoint.yaw"},
                     "setpoint"),
          about_axes({"out/actuator_controls_0.control[0]", "out/actuator_controls_0.control[1]",
                      "out/actuator_controls_0.control[2]"},
                     "control"),
          {{"out/actuator_controls_0.control[3]", "thrust"}},
          about_axes(
              {"out/mc_att_ctrl_status.roll_rate_integ", "out/mc_att_ctrl_status.pitch_rate_integ",
               "out/mc_att_ctrl_status.yaw_rate_integ"},
              "integral"),
          "Controls",
          "Saturation of the mixer"};
}

}  // namespace attest
