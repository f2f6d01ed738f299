#include "tests/harness/plant/judged.hpp"

#include <fmt/format.h>

#include "harness/plant/ode_plant.hpp"

namespace attest::test {

Judged mujoco(const VehicleModel& vehicle_model, const Rate& physics) {
  auto plant = vehicle_model.make_plant(PlantKind::mujoco, {physics, false});
  return {fmt::format("mujoco, {} Hz", physics.to_string()), std::move(*plant)};
}

Judged ode(const VehicleModel& vehicle_model) {
  return {"ode", make_ode_plant(vehicle_model.vehicle(), OdeOptions{})};
}

Judged fixed_ode(const VehicleModel& vehicle_model, int order, double step_s) {
  OdeOptions options;
  options.order = order;
  options.fixed_step_s = step_s;
  return {fmt::format("ode, order {}", order), make_ode_plant(vehicle_model.vehicle(), options)};
}

std::vector<Judged> both(const VehicleModel& vehicle_model) {
  std::vector<Judged> plants;
  plants.push_back(mujoco(vehicle_model));
  plants.push_back(ode(vehicle_model));
  return plants;
}

}  // namespace attest::test
