// The run configuration that makes a vector of a case: a loop rate; for a flight, also a vehicle
// and a plant.
#pragma once

#include <compare>
#include <optional>
#include <string>
#include <vector>

#include "harness/core/loop_rate.hpp"
#include "harness/plant/plant.hpp"

namespace attest {

// The vehicle and the plant of a flight. Its order is the order in which flights are listed.
struct PlantConfiguration {
  std::string vehicle;
  PlantKind plant = PlantKind::mujoco;

  friend auto operator<=>(const PlantConfiguration&, const PlantConfiguration&) = default;
};

struct RunConfiguration {
  LoopRate rate;
  std::optional<PlantConfiguration> plant_configuration;  // empty: open loop

  // For ids and file names: "250hz", "250hz-iris-ode" or, of a cascade, "250-1000hz-iris-ode".
  std::string label() const;

  friend bool operator==(const RunConfiguration&, const RunConfiguration&) = default;
};

}  // namespace attest
