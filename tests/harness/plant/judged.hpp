// The plants in the table of truth.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness/plant/plant.hpp"

namespace attest::test {

// The name is that in the table. The vehicle model must outlive the plant.
struct Judged {
  std::string name;
  std::unique_ptr<Plant> plant;
};

Judged mujoco(const VehicleModel& vehicle_model, const Rate& physics = Rate::hz(1000));
Judged ode(const VehicleModel& vehicle_model);
Judged fixed_ode(const VehicleModel& vehicle_model, int order, double step_s);
std::vector<Judged> both(const VehicleModel& vehicle_model);

}  // namespace attest::test
