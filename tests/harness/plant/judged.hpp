// The plants that the table of truth is about.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness/plant/plant.hpp"

namespace attest::test {

// Named as the table names it. The airframe must outlive it.
struct Judged {
  std::string name;
  std::unique_ptr<Plant> plant;
};

Judged mujoco(const Airframe& airframe, const Rate& physics = Rate::hz(1000));
Judged ode(const Airframe& airframe);
Judged fixed_ode(const Airframe& airframe, int order, double step_s);
std::vector<Judged> both(const Airframe& airframe);

}  // namespace attest::test
