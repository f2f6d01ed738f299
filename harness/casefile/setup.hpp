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
struct Flyer {
  std::string vehicle;
  PlantKind plant = PlantKind::mujoco;

  friend auto operator<=>(const Flyer&, const Flyer&) = default;
};

struct Setup {
  Rate rate = Rate::hz(1);
  std::optional<Flyer> flyer;  // empty: open loop

  // For ids and file names: "250hz" or "250hz-iris-ode".
  std::string label() const;

  friend bool operator==(const Setup&, const Setup&) = default;
};

}  // namespace attest
