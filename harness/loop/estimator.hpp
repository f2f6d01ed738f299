// The plant's state as a unit receives it: in float32, with seeded noise if the case has some.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "controller/attest_unit.h"
#include "harness/casefile/case.hpp"
#include "harness/core/random.hpp"
#include "harness/core/time.hpp"
#include "harness/loop/gyro_filter.hpp"
#include "harness/plant/plant.hpp"

namespace attest {

using ControlState = decltype(attest_inputs::control_state);

// An estimate of the plant's state. `sampled`: the time of that state, since the start of the case.
struct Estimate {
  Nanoseconds sampled{0};
  ControlState state{};                        // of the rate unit, filtered rates
  std::array<float, 3> acceleration_rad_s2{};  // angular acceleration, for the rate unit
  // For the attitude unit: the number of resets of the estimator, and the rotation of the last one.
  std::uint8_t resets = 0;
  std::array<float, 4> delta_q_reset{1, 0, 0, 0};
};

// The exact state, in float32.
ControlState control_state_of(const PlantState& state);

// The same seed gives the same noise for every plant, on every platform. No allocation.
class NoisyEstimator {
 public:
  explicit NoisyEstimator(const Estimator& options) : options_(options), random_(options.seed) {}

  ControlState sample(const PlantState& state);

 private:
  Vector3 normal(double deviation);

  Estimator options_;
  Random random_;
};

// Takes the samples of one unit: the attitude estimate with its resets for the attitude unit, the
// filtered gyro for the rate unit, attitude and rates for the controller. The noise of the
// cascade's gyro uses the estimator's seed plus 1. No allocation.
class UnitEstimator {
 public:
  // `own` is the rate of the unit of the case's module, `timeline` that of the unit that commands
  // the motors. REQUIRES: a flight.
  UnitEstimator(const Case& the_case, const Rate& own, const Rate& timeline);

  Estimate sample(Nanoseconds now, const PlantState& state);

 private:
  struct Reset {
    Nanoseconds at;
    Quaternion turn;
  };
  void filter(Estimate& estimate);

  NoisyEstimator noisy_;
  std::optional<Reset> reset_;
  std::optional<GyroFilter> gyro_filter_;
};

}  // namespace attest
