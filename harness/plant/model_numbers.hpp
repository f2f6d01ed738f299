// Compares a MuJoCo model with the TOML of its vehicle. Both plants must fly the same vehicle.
#pragma once

#include <string>
#include <vector>

#include "harness/core/frames.hpp"
#include "harness/plant/vehicle.hpp"

namespace attest {

// The numbers of a compiled model. FRD, SI units.
struct ModelNumbers {
  struct Rotor {
    Vector3 position_m;
    Vector3 force_gear;     // force divided by thrust
    Vector3 torque_gear_m;  // torque divided by thrust
    double thrust_coefficient;
    double time_constant_up_s;
    double time_constant_down_s;
  };
  double mass_kg = 0;
  Vector3 inertia_kg_m2{};
  Vector3 centre_of_mass_m{};
  double gravity_m_s2 = 0;
  std::vector<Rotor> rotors;
};

// Describes the first quantity that differs from the vehicle's, with both values. Returns an empty
// text if all agree.
std::string first_difference(const ModelNumbers& model, const Vehicle& vehicle);

}  // namespace attest
