// One way to run a case: at a loop rate, and if the case is a flight, with a vehicle on a plant.
#pragma once

#include <compare>
#include <optional>
#include <string>
#include <vector>

#include "harness/plant/plant.hpp"
#include "harness/schedule/rate.hpp"

namespace attest {

// What flies: in the order flights are listed.
struct PlantConfiguration {
  std::string vehicle;
  PlantKind plant = PlantKind::mujoco;

  friend auto operator<=>(const PlantConfiguration&, const PlantConfiguration&) = default;
};

struct RunConfiguration {
  Rate rate = Rate::hz(1);
  std::optional<PlantConfiguration> plant_configuration;  // empty: open loop

  // For ids and file names: "250hz" or "250hz-iris-ode".
  std::string label() const;

  friend bool operator==(const RunConfiguration&, const RunConfiguration&) = default;
};

}  // namespace attest
