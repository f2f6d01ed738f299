#include "harness/report/html/flight_plots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/report/html/base64.hpp"
#include "harness/report/html/curves.hpp"
#include "harness/report/html/script_json.hpp"
#include "harness/trace/plant_columns.hpp"

namespace attest {
namespace {

using nlohmann::json;

constexpr std::size_t most_flight_points = 2000;  // of a plot
constexpr std::size_t most_frames = 2000;         // of the replay

struct Series {
  std::string name;
  std::vector<float> values;
};

// The column of that name: a channel, or one of the plant.
std::vector<float> column(const Trace& flown, std::string_view name) {
  std::vector<float> values;
  if (const auto channel = find_channel(name)) {
    for (const Sample& sample : flown.samples) {
      values.push_back(static_cast<float>(value_of(channels()[*channel], sample)));
    }
    return values;
  }
  const auto columns = plant_columns();
  const auto found = std::find_if(columns.begin(), columns.end(),
                                  [&](const PlantColumn& one) { return one.name == name; });
  for (const PlantSample& sample : flown.plant) values.push_back(found->value(sample));
  return values;
}

using Quaternions = std::array<std::vector<float>, 4>;

Quaternions quaternions(const Trace& flown, const std::string& name) {
  Quaternions out;
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = column(flown, name + "[" + std::to_string(i) + "]");
  }
  return out;
}

// Roll, pitch and yaw [deg] of the rotation from body to world, in this order of the axes: yaw,
// then pitch, then roll (as the class Euler of PX4).
std::array<float, 3> euler_deg(float w, float x, float y, float z) {
  const float degrees = 180 / std::numbers::pi_v<float>;
  const float sin_pitch = std::clamp(2 * (w * y - z * x), -1.0f, 1.0f);
  return {degrees * std::atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
          degrees * std::asin(sin_pitch),
          degrees * std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))};
}

std::vector<Series> angles(const Quaternions& q, const std::string& of) {
  std::vector<Series> series = {{of + "roll", {}}, {of + "pitch", {}}, {of + "yaw", {}}};
  for (std::size_t tick = 0; tick < q[0].size(); ++tick) {
    const auto angles_deg = euler_deg(q[0][tick], q[1][tick], q[2][tick], q[3][tick]);
    for (std::size_t i = 0; i < 3; ++i) series[i].values.push_back(angles_deg[i]);
  }
  return series;
}

std::vector<float> seconds(const Trace& flown, const std::vector<std::size_t>& ticks) {
  std::vector<float> out;
  for (const std::size_t tick : ticks) {
    const std::uint64_t elapsed_us =
        flown.samples[tick].in.timestamp - flown.samples.front().in.timestamp;
    out.push_back(static_cast<float>(1e-6 * static_cast<double>(elapsed_us)));
  }
  return out;
}

std::string at(const std::vector<float>& values, const std::vector<std::size_t>& ticks) {
  std::vector<float> out;
  for (const std::size_t tick : ticks) out.push_back(values[tick]);
  return base64(out);
}

json plot(const Trace& flown, const char* title, const char* unit,
          const std::vector<Series>& series) {
  std::vector<std::vector<float>> values;
  for (const Series& one : series) values.push_back(one.values);
  const std::vector<std::size_t> ticks = extreme_ticks(values, most_flight_points);
  json out = {{"title", title},
              {"unit", unit},
              {"tick", base64(std::vector<float>(ticks.begin(), ticks.end()))},
              {"time", base64(seconds(flown, ticks))},
              {"series", json::array()}};
  for (const Series& one : series) {
    out["series"].push_back({{"name", one.name}, {"values", at(one.values, ticks)}});
  }
  return out;
}

json plot_of_columns(const Trace& flown, const char* title, const char* unit,
                     const std::vector<std::string>& names) {
  std::vector<Series> series;
  for (const std::string& name : names) series.push_back({name, column(flown, name)});
  return plot(flown, title, unit, series);
}

// The columns of the motors that this vehicle has.
std::vector<std::string> motors(const Trace& flown) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::tuple_size_v<decltype(PlantSample::motor)>; ++i) {
    const bool turns = std::any_of(flown.plant.begin(), flown.plant.end(),
                                   [i](const PlantSample& s) { return s.rotor_rad_s[i] != 0; });
    if (turns || i == 0)
      names.push_back("plant/actuator_outputs.output[" + std::to_string(i) + "]");
  }
  return names;
}

json replay(const Trace& flown, const Quaternions& attitude, const Quaternions& setpoint) {
  std::vector<std::size_t> ticks;
  const std::size_t size = flown.samples.size();
  const std::size_t frames = std::min(size, most_frames);
  for (std::size_t i = 0; i < frames; ++i) ticks.push_back(i * size / frames);
  json out = {{"time", base64(seconds(flown, ticks))}};
  for (std::size_t i = 0; i < attitude.size(); ++i) {
    out["attitude"].push_back(at(attitude[i], ticks));
    out["setpoint"].push_back(at(setpoint[i], ticks));
  }
  return out;
}

}  // namespace

std::string flight_plots_json(const Trace& flown) {
  const Quaternions attitude = quaternions(flown, "plant/vehicle_attitude.q");
  const Quaternions setpoint = quaternions(flown, "in/vehicle_attitude_setpoint.q_d");
  std::vector<Series> all_angles = angles(attitude, "");
  for (Series& one : angles(setpoint, "setpoint ")) all_angles.push_back(std::move(one));
  const json plots = {
      plot(flown, "Attitude", "deg", all_angles),
      plot_of_columns(flown, "Body rates", "rad/s",
                      {"plant/vehicle_attitude.rollspeed", "plant/vehicle_attitude.pitchspeed",
                       "plant/vehicle_attitude.yawspeed", "out/vehicle_rates_setpoint.roll",
                       "out/vehicle_rates_setpoint.pitch", "out/vehicle_rates_setpoint.yaw"}),
      plot_of_columns(flown, "Controls", "",
                      {"out/actuator_controls_0.control[0]", "out/actuator_controls_0.control[1]",
                       "out/actuator_controls_0.control[2]", "out/actuator_controls_0.control[3]"}),
      plot_of_columns(
          flown, "Integrals", "",
          {"out/mc_att_ctrl_status.roll_rate_integ", "out/mc_att_ctrl_status.pitch_rate_integ",
           "out/mc_att_ctrl_status.yaw_rate_integ"}),
      plot_of_columns(flown, "Motor commands", "", motors(flown)),
      plot_of_columns(flown, "Saturation of the mixer", "", {"plant/mixer.saturated"}),
      plot_of_columns(flown, "Position", "m",
                      {"plant/vehicle_local_position.x", "plant/vehicle_local_position.y",
                       "plant/vehicle_local_position.z"})};
  return script_json({{"plots", plots}, {"replay", replay(flown, attitude, setpoint)}});
}

}  // namespace attest
