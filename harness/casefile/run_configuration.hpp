// The run configuration that makes a vector of a case: a loop rate; for a flight, also a vehicle
// and a plant.
#pragma once

#include <compare>
#include <optional>
#include <string>
#include <vector>

#include "harness/plant/plant.hpp"
#include "harness/schedule/rate.hpp"

namespace attest {

// The vehicle and the plant of a flight. Its order is the order in which flights are listed.
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
