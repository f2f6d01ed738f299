// A vehicle as numbers. Both plants are made from it. Read from models/<name>.toml, which gives the
// source of each number.
//
// Body frame FRD, its origin at the nominal centre of mass. SI units.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/core/frames.hpp"
#include "harness/core/result.hpp"

namespace attest {

inline constexpr std::size_t rotors_max = 8;

// A vehicle has its rotors in the order of the mixer's outputs.
struct VehicleRotor {
  Vector3 position_m;  // of the hub
  int turns = 1;       // +1 counter-clockwise seen from above, -1 clockwise
};

// Voltage = full_V - fall_V * used fraction of the charge - resistance_ohm * low-passed current.
// The current is hover_current_A in hover. It is proportional to the rotors' power, which grows as
// the cube of their speed.
struct BatteryPack {
  int cells = 3;
  double full_V = 0;  // open circuit
  double fall_V = 0;  // from full to empty
  double resistance_ohm = 0;
  double capacity_Ah = 0;
  double current_filter_s = 0;
  double hover_current_A = 0;
};

struct Vehicle {
  std::string name;            // stem of the file: "iris"
  std::filesystem::path file;  // models/iris.toml
  std::string description;     // one line, for lists
  double mass_kg = 0;
  Vector3 inertia_kg_m2{};  // about the centre of mass, principal axes along the body axes
  std::vector<VehicleRotor> rotors;
  double thrust_coefficient = 0;    // kf [N/(rad/s)^2]: thrust = kf w^2, along -z
  double torque_over_thrust_m = 0;  // km/kf: drag torque = km/kf * thrust, against the rotation
  double time_constant_up_s = 0;    // of the rotor speed towards a higher command
  double time_constant_down_s = 0;  // of the rotor speed towards a lower command
  double rotor_max_rad_s = 0;       // at the motor command 1
  Vector3 drag_kg_s{};  // optional, by body axis: force = -drag * velocity relative to the air
  double rate_bound_rad_s = 0;  // beyond this body rate a flight has diverged
  BatteryPack battery;
  std::string mixer;                                       // "R: 4x 10000 10000 10000 0"
  std::vector<std::pair<std::string, double>> parameters;  // of the law: gains for this vehicle

  // The vehicle whose MuJoCo model this one uses, with its own numbers. If empty, it uses
  // models/<name>.xml.
  std::string mjcf_of;

  // Of the files() from which the vehicle was loaded. A model that is read later from disk may be
  // another one. `mjcf_sha256` is empty until VehicleModel::load().
  std::string sha256, mjcf_sha256;

  // The files of the vehicle: models/<name>.toml, and models/<name>.xml or the .xml of `mjcf_of`.
  std::vector<std::filesystem::path> files() const;

  double hover_rotor_rad_s() const;  // the same for all rotors
  // The power of rotors at these speeds [rad/s] divided by that in hover. Power grows as the cube
  // of the speed. REQUIRES: one speed per rotor.
  double power_ratio(std::span<const double> rotor_rad_s) const;
  double arm_m() const;  // from the centre of mass to the farthest hub
  // The thrust control, 0..1, at which the vehicle hovers. Rotor speed is proportional to it.
  double hover_thrust() const { return hover_rotor_rad_s() / rotor_max_rad_s; }
};

inline constexpr double gravity_m_s2 = 9.80665;  // standard gravity, ISO 80000-3

// Errors name file, line and fix: a number that is missing or impossible (such as a mass that is
// not positive, an inertia that breaks the triangle inequality, rotors that cannot lift the
// vehicle), an unknown key or parameter, a mixer whose rotors are at other places.
Result<Vehicle> read_vehicle(const std::filesystem::path& file);
// Reads the text of a file. The file itself need not exist.
Result<Vehicle> parse_vehicle(std::string_view text, const std::filesystem::path& file);

// The names of the vehicles (*.toml) in a folder, sorted; empty when there is no such folder.
std::vector<std::string> vehicle_names(const std::filesystem::path& models);

}  // namespace attest
