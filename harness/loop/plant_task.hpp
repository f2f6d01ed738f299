// The plant with its disturbances, supply and actuators: the same in simulation and on a real
// clock. One thread at a time uses a PlantTask.
#pragma once

#include <optional>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/loop/actuators.hpp"
#include "harness/loop/disturbances.hpp"
#include "harness/loop/supply.hpp"
#include "harness/plant/plant.hpp"

namespace attest {

class PlantTask {
 public:
  // Resets the plant to the start of the flight. REQUIRES: same as ClosedLoop (closed_loop.hpp).
  PlantTask(const Case& the_case, const Rate& rate, const Vehicle& vehicle, Plant& plant);

  // The times at which disturb() must be called.
  const std::vector<Nanoseconds>& disturbance_times() const { return disturbances_.times(); }

  std::optional<Divergence> advance(Nanoseconds to) { return plant_.advance(to); }

  // Sets wind, centre of mass and motor failure to their values at `now`. REQUIRES: the plant was
  // advanced to `now`.
  std::optional<Divergence> disturb(Nanoseconds now);

  // The motors follow `commands` from `now` on, until the next call. Before the first call they
  // turn as at the start. Returns a Divergence if a command is not finite.
  std::optional<Divergence> command(Nanoseconds now, const MotorCommands& commands);

  // Same as Supply::sample.
  float battery_scale(Nanoseconds now, float throttle, bool armed) {
    return supply_.sample(now, plant_.state(), throttle, armed);
  }

  const PlantState& state() const { return plant_.state(); }
  double voltage_V() const { return supply_.voltage_V(); }

 private:
  std::optional<Divergence> hold(Nanoseconds now);

  Plant& plant_;
  Disturbances disturbances_;
  Supply supply_;
  Actuators actuators_;
  std::optional<MotorCommands> held_;
};

}  // namespace attest
