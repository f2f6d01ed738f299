// Vehicle files. The numbers of a vehicle that is read are finite, and it can hover.
#include "harness/plant/vehicle.hpp"

#include <cmath>
#include <vector>

#include "tests/fuzz/fuzz.hpp"

namespace attest::fuzz {
namespace {

void require_flies(const Vehicle& vehicle) {
  require(vehicle.rotors.size() >= 3 && vehicle.rotors.size() <= rotors_max, "3 to 8 rotors");
  require(vehicle.hover_thrust() > 0 && vehicle.hover_thrust() < 1, "it hovers");
  require(std::isfinite(vehicle.arm_m()) && vehicle.arm_m() > 0, "it has arms");
  for (const double moment : vehicle.inertia_kg_m2) require(std::isfinite(moment), "inertia");
  for (const double drag : vehicle.drag_kg_s) require(std::isfinite(drag), "drag");
  for (const VehicleRotor& rotor : vehicle.rotors) {
    for (const double place : rotor.position_m) require(std::isfinite(place), "place of a rotor");
  }
  const std::vector<double> hover(vehicle.rotors.size(), vehicle.hover_rotor_rad_s());
  require(std::abs(vehicle.power_ratio(hover) - 1) < 1e-9, "its power in hover is the unit");
  require(vehicle.battery.cells >= 1 && vehicle.battery.cells <= 1000, "cells");
}

}  // namespace
}  // namespace attest::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace attest;
  const auto file = fuzz::write("vehicle.toml", fuzz::text_of(data, size));
  const auto vehicle = read_vehicle(file);
  if (vehicle) {
    fuzz::require_flies(*vehicle);
  } else {
    fuzz::require_readable(vehicle.error(), file);
  }
  return 0;
}
