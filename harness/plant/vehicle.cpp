#include "harness/plant/vehicle.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "controller/actuation/mixer.hpp"
#include "controller/mc_att_control/parameters.hpp"
#include "harness/core/file.hpp"
#include "harness/core/suggestion.hpp"
#include "harness/core/suite_files.hpp"
#include "harness/core/toml.hpp"

namespace attest {
namespace {

namespace fs = std::filesystem;

double positive(const TomlTable& table, const std::string& key) {
  const double value = table.number(key);
  if (table.has(key) && !(value > 0 && std::isfinite(value))) table.error(key, "must be positive");
  return value;
}

double not_negative(const TomlTable& table, const std::string& key, double fallback) {
  const double value = table.number(key, fallback);
  if (!(value >= 0 && std::isfinite(value))) table.error(key, "must not be negative");
  return value;
}

Vector3 vector_of(const TomlTable& table, const std::string& key) {
  const std::vector<double> numbers = table.numbers(key);
  const bool is_finite = std::all_of(numbers.begin(), numbers.end(),
                                     [](double number) { return std::isfinite(number); });
  if (numbers.size() == 3 && is_finite) return {numbers[0], numbers[1], numbers[2]};
  if (table.has(key)) table.error(key, "needs three finite numbers, along x, y and z");
  return {};
}

Vector3 read_inertia(const TomlTable& root) {
  const Vector3 inertia = vector_of(root, "inertia_kg_m2");
  const auto [x, y, z] = inertia;
  // No body has a principal moment above the sum of the other two.
  const bool possible = x > 0 && y > 0 && z > 0 && x <= y + z && y <= x + z && z <= x + y;
  if (root.has("inertia_kg_m2") && !possible) {
    root.error("inertia_kg_m2",
               "is impossible: each moment must be positive and at most the sum of the "
               "other two");
  }
  return inertia;
}

Vector3 read_drag(const TomlTable& root) {
  if (!root.has("drag_kg_s")) return {};
  const Vector3 drag = vector_of(root, "drag_kg_s");
  const bool sane = std::all_of(drag.begin(), drag.end(), [](double d) { return d >= 0; });
  if (!sane) root.error("drag_kg_s", "must not be negative");
  return drag;
}

// Farther than on any vehicle, and small enough that no moment overflows.
constexpr double farthest_rotor_m = 100;

Vector3 read_place(const TomlTable& rotor) {
  const Vector3 place = vector_of(rotor, "position_m");
  const bool is_near = std::all_of(place.begin(), place.end(),
                                   [](double x) { return std::abs(x) <= farthest_rotor_m; });
  if (!is_near) rotor.error("position_m", "must be at most 100 m from the centre of mass");
  return place;
}

// One table per rotor: [rotors] r0 = { position_m = [x, y, z], turns = "ccw" }, ...
std::vector<VehicleRotor> read_rotors(const TomlTable& root) {
  std::vector<VehicleRotor> rotors;
  const TomlTable table = root.table("rotors");
  for (std::size_t i = 0; table.has(fmt::format("r{}", i)); ++i) {
    const std::string key = fmt::format("r{}", i);
    const TomlTable rotor = table.table(key);
    const std::string turns = rotor.text("turns");
    if (rotor.has("turns") && turns != "ccw" && turns != "cw") {
      rotor.error("turns", "must be \"ccw\" or \"cw\", as seen from above");
    }
    rotors.push_back({read_place(rotor), turns == "cw" ? -1 : 1});
  }
  if (root.has("rotors") && (rotors.size() < 3 || rotors.size() > rotors_max)) {
    root.error("rotors", fmt::format("needs r0, r1, ...: from 3 to {} rotors", rotors_max));
  }
  return rotors;
}

constexpr int most_cells = 100;

BatteryPack read_battery(const TomlTable& root) {
  const TomlTable table = root.table("battery");
  BatteryPack pack;
  const std::int64_t cells = table.integer("cells");
  if (table.has("cells") && (cells < 1 || cells > most_cells)) {
    table.error("cells", fmt::format("must be from 1 to {}", most_cells));
  } else {
    pack.cells = static_cast<int>(cells);
  }
  pack.full_V = positive(table, "full_V");
  pack.fall_V = positive(table, "fall_V");
  if (pack.fall_V >= pack.full_V) table.error("fall_V", "must be below `full_V`");
  pack.resistance_ohm = not_negative(table, "resistance_ohm", 0);
  pack.capacity_Ah = positive(table, "capacity_Ah");
  pack.current_filter_s = not_negative(table, "current_filter_s", 0);
  pack.hover_current_A = positive(table, "hover_current_A");
  return pack;
}

// Returns the difference between a rotor and its rotor in the mixer, if there is one. In the mixer,
// rotors on the left have a positive roll scale, those in front a positive pitch scale, and those
// that turn counter-clockwise a positive yaw scale.
std::optional<std::string> disagreement(const VehicleRotor& rotor, const actuation::Rotor& mixed) {
  constexpr double small = 1e-3;
  const auto differs = [&](double place, float scale) {
    const double s = static_cast<double>(scale);
    return (std::abs(s) > small && place * s <= 0) || (std::abs(s) <= small && place != 0);
  };
  if (differs(-rotor.position_m[1], mixed.roll)) return "on another side (y)";
  if (differs(rotor.position_m[0], mixed.pitch)) return "on another side (x)";
  if ((rotor.turns > 0) != (mixed.yaw > 0)) return "turning the other way";
  return std::nullopt;
}

void check_mixer(const TomlTable& root, const Vehicle& vehicle) {
  if (!root.has("mixer") || !root.has("rotors")) return;
  const auto mixer = actuation::parse_mixer(vehicle.mixer);
  if (!mixer) return root.error("mixer", mixer.error());
  if (mixer->rotors.size() != vehicle.rotors.size()) {
    return root.error("mixer", fmt::format("has {} rotors, the vehicle {}", mixer->rotors.size(),
                                           vehicle.rotors.size()));
  }
  const TomlTable rotors = root.table("rotors");
  for (std::size_t i = 0; i < vehicle.rotors.size(); ++i) {
    if (const auto what = disagreement(vehicle.rotors[i], mixer->rotors[i])) {
      rotors.error(fmt::format("r{}", i),
                   fmt::format("the mixer `{}` has output {} {}", vehicle.mixer, i, *what));
    }
  }
}

void check_hover(const TomlTable& root, const Vehicle& vehicle) {
  if (vehicle.rotors.empty() || !(vehicle.hover_thrust() < 1)) {
    root.error("rotor_max_rad_s", fmt::format("cannot lift the vehicle: it hovers at {:.0f} rad/s",
                                              vehicle.hover_rotor_rad_s()));
  }
}

void check_parameter(const TomlTable& parameters, const std::string& name, double value) {
  std::vector<std::string> known;
  for (const auto& info : mc_att_control::parameter_table()) known.emplace_back(info.name);
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    parameters.error(name, fmt::format("unknown parameter `{}`{}; `attest list --parameters` shows "
                                       "them all",
                                       name, suggestion(name, known)));
  } else if (!std::isfinite(value)) {
    parameters.error(name, "must be a finite number");
  }
}

void read_root(const TomlTable& root, Vehicle& vehicle) {
  vehicle.description = root.text("description");
  vehicle.mass_kg = positive(root, "mass_kg");
  vehicle.inertia_kg_m2 = read_inertia(root);
  vehicle.rotors = read_rotors(root);
  vehicle.thrust_coefficient = positive(root, "thrust_coefficient");
  vehicle.torque_over_thrust_m = positive(root, "torque_over_thrust_m");
  vehicle.time_constant_up_s = positive(root, "time_constant_up_s");
  vehicle.time_constant_down_s = positive(root, "time_constant_down_s");
  vehicle.rotor_max_rad_s = positive(root, "rotor_max_rad_s");
  vehicle.drag_kg_s = read_drag(root);
  vehicle.rate_bound_rad_s = positive(root, "rate_bound_rad_s");
  vehicle.battery = read_battery(root);
  vehicle.mixer = root.text("mixer");
  vehicle.mjcf_of = root.text("mjcf_of", "");
  if (root.has("parameters")) {
    const TomlTable parameters = root.table("parameters");
    for (const std::string& name : parameters.keys()) {
      vehicle.parameters.emplace_back(name, parameters.number(name));
      check_parameter(parameters, name, vehicle.parameters.back().second);
    }
  }
  check_mixer(root, vehicle);
  const bool complete = vehicle.mass_kg > 0 && vehicle.thrust_coefficient > 0 &&
                        vehicle.rotor_max_rad_s > 0 && root.has("rotors");
  if (complete) check_hover(root, vehicle);
}

}  // namespace

std::vector<fs::path> Vehicle::files() const {
  const fs::path own = fs::path(file).replace_extension(".xml");
  return {file, mjcf_of.empty() ? own : own.parent_path() / (mjcf_of + ".xml")};
}

double Vehicle::hover_rotor_rad_s() const {
  const double of_one = mass_kg * gravity_m_s2 / static_cast<double>(rotors.size());
  return std::sqrt(of_one / thrust_coefficient);
}

double Vehicle::power_ratio(std::span<const double> rotor_rad_s) const {
  const double hover_rad_s = hover_rotor_rad_s();
  double sum = 0;
  for (const double speed : rotor_rad_s.first(rotors.size())) {
    const double ratio = speed / hover_rad_s;
    sum += ratio * ratio * ratio;
  }
  return sum / static_cast<double>(rotors.size());
}

double Vehicle::arm_m() const {
  double longest = 0;
  for (const VehicleRotor& rotor : rotors) {
    const auto [x, y, z] = rotor.position_m;
    longest = std::max(longest, std::sqrt(x * x + y * y));
  }
  return longest;
}

Result<Vehicle> read_vehicle(const fs::path& file) {
  return read_suite_file(file).and_then(
      [&](const std::string& text) { return parse_vehicle(text, file); });
}

Result<Vehicle> parse_vehicle(std::string_view text, const fs::path& file) {
  auto toml = TomlFile::parse(text, file.string());
  if (!toml) return tl::unexpected(toml.error());
  Vehicle vehicle;
  vehicle.name = file.stem().string();
  vehicle.file = file;
  vehicle.sha256 = sha256(text);
  read_root(toml->root(), vehicle);
  if (auto done = toml->finish(); !done) return tl::unexpected(done.error());
  return vehicle;
}

std::vector<std::string> vehicle_names(const fs::path& models) {
  std::vector<std::string> names;
  for (const fs::path& file : suite_files_below(models).value_or(std::vector<fs::path>())) {
    const bool is_vehicle = file.extension() == ".toml" && file.parent_path() == models;
    if (is_vehicle) names.push_back(file.stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace attest
