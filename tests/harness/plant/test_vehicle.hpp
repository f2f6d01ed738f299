// Vehicles that tests write as files: their properties are known exactly.
#pragma once

#include <memory>
#include <string>

#include "harness/plant/plant.hpp"
#include "tests/harness/core/temporary_directory.hpp"

namespace attest::test {

// A quadrotor x with arms of 0.2 m, and the numbers that a test may choose.
struct Numbers {
  double mass_kg = 1;
  Vector3 inertia_kg_m2{0.01, 0.015, 0.02};
  double time_constant_up_s = 0.02;
  double time_constant_down_s = 0.05;
  Vector3 drag_kg_s{};
  double rate_bound_rad_s = 1000;
};

// Writes <folder>/brick.toml and brick.xml.
void write_vehicle(const std::filesystem::path& folder, const Numbers& numbers);

// Loads it through the files. Throws their error.
std::shared_ptr<const VehicleModel> vehicle_model(const Numbers& numbers);

// A vehicle of the repository.
std::shared_ptr<const VehicleModel> vehicle_model(const std::string& name);

}  // namespace attest::test
