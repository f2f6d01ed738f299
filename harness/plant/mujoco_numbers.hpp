// The numbers of a compiled MuJoCo model: reads them, and replaces them by those of a vehicle.
#pragma once

#include <filesystem>

#include "harness/core/result.hpp"
#include "harness/plant/model_numbers.hpp"

struct mjModel_;

namespace attest {

namespace mujoco_layout {

inline constexpr int body = 1;  // 0 is the world

// userdata of mjData: linear drag [kg/s] by body axis FLU, velocity of the air [m/s] ENU.
enum UserData : int { drag_at = 0, wind_at = 3, userdata_size = 6 };

}  // namespace mujoco_layout

// The numbers that first_difference() compares with the TOML. Errors: a model that lacks an element
// which the plant needs; the text names the element.
Result<ModelNumbers> numbers_of(const mjModel_& model, const std::filesystem::path& xml);

// Sets the numbers that first_difference() compares, except gravity, centre of mass and those gears
// of a rotor that must have the same value in each model. The caller updates the values that MuJoCo
// derives from them (mj_setConst). REQUIRES: as many rotors as the vehicle has.
void set_numbers(const Vehicle& vehicle, mjModel_& model);

}  // namespace attest
