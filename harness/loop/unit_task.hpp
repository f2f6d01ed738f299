// The work of the flight controller at a tick of a unit: the same in simulation and on a real
// clock. One thread at a time uses a UnitTask.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/casefile/stimulus.hpp"
#include "harness/core/float_environment.hpp"
#include "harness/loop/actuators.hpp"
#include "harness/loop/estimator.hpp"
#include "harness/loop/land_detector.hpp"
#include "harness/loop/unit_driver.hpp"
#include "harness/plant/vehicle.hpp"
#include "harness/port/port.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// What the attitude unit sends to the rate unit.
using RatesSetpoint = decltype(attest_rate_inputs::vehicle_rates_setpoint);

// Empty if the attitude unit did not publish vehicle_rates_setpoint at this tick.
std::optional<RatesSetpoint> rates_setpoint_of(const attest_attitude_outputs& outputs);

// The latest message of each kind that has arrived since the last tick.
struct Arrivals {
  std::optional<Estimate> estimate;
  std::optional<float> battery_scale;
  std::optional<Saturation> saturation;
  std::optional<LandDetected> landed;
  std::optional<RatesSetpoint> rates_setpoint;
};

class UnitTask {
 public:
  // `the_case` comes from Case::of_module(). `rate` is that of the unit that commands the motors.
  // `start`: the estimate used until the first one arrives. REQUIRES: `unit` is of the case's
  // module; otherwise same as ClosedLoop (closed_loop.hpp).
  UnitTask(const Case& the_case, const Rate& rate, const Vehicle& vehicle, Unit& unit,
           const Estimate& start);

  // Fills the inputs from stimulus and arrivals, steps the unit, and gives its outputs to the mixer
  // or the allocator. Allocates memory only for parameters that change. REQUIRES: `tick` counts
  // from 0, `now` increases.
  std::optional<PortFault> tick(std::size_t tick, Nanoseconds now, const Arrivals& arrivals);

  // The two halves of tick(), for callers that measure step() alone: prepare() fills the inputs,
  // step() does the rest.
  void prepare(std::size_t tick, Nanoseconds now, const Arrivals& arrivals);
  std::optional<PortFault> step(std::size_t tick);

  Module module() const { return module_; }

  // Of the last tick.
  const Sample& sample() const { return sample_; }
  std::span<const StepCost> costs() const { return driver_.costs(); }
  const std::vector<ParameterChange>& changes() const { return changes_; }
  const MotorCommands& commands() const { return actuators_.commands(); }
  const Saturation& saturation() const { return actuators_.saturation(); }
  bool is_armed() const { return info_of(module_).is_armed(sample_); }
  float throttle() const;  // collective thrust, 0..1 upwards; not for the attitude unit

 private:
  void take(const Arrivals& arrivals, attest_inputs& in);
  void take(const Arrivals& arrivals, attest_attitude_inputs& in);
  void take(const Arrivals& arrivals, attest_rate_inputs& in);

  Module module_;
  Stimulus stimulus_;
  Sampler airmode_signal_;
  Actuators actuators_;
  UnitDriver driver_;
  PortFloatEnvironment ports_;
  Sample sample_{};
  Airmode airmode_ = Airmode::off;
  Estimate estimate_;
  std::vector<ParameterChange> changes_;
};

}  // namespace attest
