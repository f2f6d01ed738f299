#include "harness/trace/plant_columns.hpp"

#include <array>
#include <vector>

#include <fmt/format.h>

namespace attest {
namespace {

using Read = float (*)(const PlantSample&, std::size_t);

// Adds one column for each name of `fields`.
void add(std::vector<PlantColumn>& columns, std::string_view topic,
         std::initializer_list<std::string_view> fields, std::string_view unit, Read read) {
  std::size_t index = 0;
  for (const std::string_view field : fields) {
    columns.push_back(
        {fmt::format("{}{}.{}", plant_prefix, topic, field), std::string(unit), read, index++});
  }
}

void add_rotors(std::vector<PlantColumn>& columns, std::string_view name, std::string_view unit,
                Read read) {
  for (std::size_t i = 0; i < std::tuple_size_v<decltype(PlantSample::motor)>; ++i) {
    columns.push_back({fmt::format("{}{}[{}]", plant_prefix, name, i), std::string(unit), read, i});
  }
}

std::vector<PlantColumn> make_columns() {
  using S = PlantSample;
  using Index = std::size_t;
  std::vector<PlantColumn> columns;
  constexpr std::string_view position = "vehicle_local_position", attitude = "vehicle_attitude";
  add(columns, position, {"x", "y", "z"}, "m", [](const S& s, Index i) { return s.position_m[i]; });
  add(columns, position, {"vx", "vy", "vz"}, "m/s",
      [](const S& s, Index i) { return s.velocity_m_s[i]; });
  add(columns, attitude, {"q[0]", "q[1]", "q[2]", "q[3]"}, "",
      [](const S& s, Index i) { return s.q[i]; });
  add(columns, attitude, {"rollspeed", "pitchspeed", "yawspeed"}, "rad/s",
      [](const S& s, Index i) { return s.rate_rad_s[i]; });
  add_rotors(columns, "actuator_outputs.output", "",
             [](const S& s, Index i) { return s.motor[i]; });
  add_rotors(columns, "rotor_speed", "rad/s", [](const S& s, Index i) { return s.rotor_rad_s[i]; });
  add(columns, "battery_status", {"voltage_v"}, "V", [](const S& s, Index) { return s.voltage_V; });
  add(columns, "mixer", {"saturated"}, "",
      [](const S& s, Index) { return s.saturated ? 1.0f : 0.0f; });
  return columns;
}

}  // namespace

std::span<const PlantColumn> plant_columns() {
  static const std::vector<PlantColumn> columns = make_columns();
  return columns;
}

}  // namespace attest
