#include "tests/harness/plant/judged.hpp"

#include <fmt/format.h>

#include "harness/plant/ode_plant.hpp"

namespace attest::test {

Judged mujoco(const Airframe& airframe, const Rate& physics) {
  auto plant = airframe.make_plant(PlantKind::mujoco, {physics, false});
  return {fmt::format("mujoco, {} Hz", physics.to_string()), std::move(*plant)};
}

Judged ode(const Airframe& airframe) {
  return {"ode", make_ode_plant(airframe.vehicle(), OdeOptions{})};
}

Judged fixed_ode(const Airframe& airframe, int order, double step_s) {
  OdeOptions options;
  options.order = order;
  options.fixed_step_s = step_s;
  return {fmt::format("ode, order {}", order), make_ode_plant(airframe.vehicle(), options)};
}

std::vector<Judged> both(const Airframe& airframe) {
  std::vector<Judged> plants;
  plants.push_back(mujoco(airframe));
  plants.push_back(ode(airframe));
  return plants;
}

}  // namespace attest::test
