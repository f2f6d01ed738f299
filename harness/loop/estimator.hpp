// The plant's state as the unit receives it: in float32, with seeded noise if the case has some.
#pragma once

#include "controller/attest_unit.h"
#include "harness/casefile/flight.hpp"
#include "harness/core/time.hpp"
#include "harness/plant/plant.hpp"
#include "harness/schedule/random.hpp"

namespace attest {

using ControlState = decltype(attest_inputs::control_state);

// A sample of the plant, with its time since the start of the case.
struct Estimate {
  Nanoseconds sampled{0};
  ControlState state{};
};

// Without noise.
ControlState control_state_of(const PlantState& state);

// Noise of one seed is the same for every plant, on every platform. No allocation.
class NoisyEstimator {
 public:
  explicit NoisyEstimator(const Estimator& options) : options_(options), random_(options.seed) {}

  ControlState sample(const PlantState& state);

 private:
  Vector3 normal(double deviation);

  Estimator options_;
  Random random_;
};

}  // namespace attest
