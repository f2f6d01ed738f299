// The work of the flight controller at a tick of the unit: the same in simulation and on a real
// clock, for one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/casefile/stimulus.hpp"
#include "harness/core/float_environment.hpp"
#include "harness/loop/actuators.hpp"
#include "harness/loop/estimator.hpp"
#include "harness/loop/unit_driver.hpp"
#include "harness/plant/vehicle.hpp"
#include "harness/port/port.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// The messages that have arrived since the last tick.
struct Arrivals {
  std::optional<Estimate> estimate;
  std::optional<float> battery_scale;
  std::optional<MotorLimits> limits;
};

class UnitTask {
 public:
  // `start` is the state used before the first estimate arrives, that of time 0. REQUIRES: same as
  // ClosedLoop.
  UnitTask(const Case& the_case, const Rate& rate, const Vehicle& vehicle, Unit& unit,
           const ControlState& start);

  // Stimulus and arrivals -> the unit's step -> the mixer. Allocates only for parameters that
  // change. REQUIRES: `tick` counts from 0, times increase.
  std::optional<PortFault> tick(std::size_t tick, Nanoseconds now, const Arrivals& arrivals);

  // The two halves of tick(): fill the inputs; step the unit and mix. Callers can measure the
  // second alone.
  void prepare(std::size_t tick, Nanoseconds now, const Arrivals& arrivals);
  std::optional<PortFault> step(std::size_t tick);

  // Of the last tick.
  const Sample& sample() const { return sample_; }
  const std::vector<ParameterChange>& changes() const { return changes_; }
  const MotorCommands& commands() const { return actuators_.commands(); }
  const MotorLimits& limits() const { return actuators_.limits(); }
  bool is_armed() const { return sample_.in.actuator_armed.armed != 0; }

 private:
  Stimulus stimulus_;
  Actuators actuators_;
  UnitDriver driver_;
  PortFloatEnvironment ports_;
  Sample sample_{};
  std::uint64_t timestamp_sample_us_ = 0;  // of the sample's control_state
  Nanoseconds sampled_{0};
  std::vector<ParameterChange> changes_;
};

}  // namespace attest
