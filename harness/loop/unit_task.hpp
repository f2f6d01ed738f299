// The work of the flight controller at a tick of a unit. It is the same in simulation and on a real
// clock. One thread uses a UnitTask.
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
#include "harness/loop/land_detector.hpp"
#include "harness/loop/unit_driver.hpp"
#include "harness/plant/vehicle.hpp"
#include "harness/port/port.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// What the attitude unit sends to the rate unit.
using RatesSetpoint = decltype(attest_rate_inputs::vehicle_rates_setpoint);

// Empty: it published none at this tick.
std::optional<RatesSetpoint> rates_setpoint_of(const attest_attitude_outputs& outputs);

// The messages that have arrived since the last tick.
struct Arrivals {
  std::optional<Estimate> estimate;
  std::optional<float> battery_scale;
  std::optional<Saturation> saturation;
  std::optional<LandDetected> landed;
  std::optional<RatesSetpoint> rates_setpoint;
};

class UnitTask {
 public:
  // A unit of the case's module. `start`: the estimate of time 0, used until the first one arrives.
  // REQUIRES: same as ClosedLoop.
  UnitTask(const Case& the_case, const Rate& rate, const Vehicle& vehicle, Unit& unit,
           const Estimate& start);

  // Stimulus and arrivals -> the unit's step -> the actuators. Allocates only for parameters that
  // change. REQUIRES: `tick` counts from 0, times increase.
  std::optional<PortFault> tick(std::size_t tick, Nanoseconds now, const Arrivals& arrivals);

  // The two halves of tick(): fill the inputs; step the unit and mix. Callers can measure the
  // second alone.
  void prepare(std::size_t tick, Nanoseconds now, const Arrivals& arrivals);
  std::optional<PortFault> step(std::size_t tick);

  Module module() const { return module_; }

  // Of the last tick.
  const Sample& sample() const { return sample_; }
  const std::vector<ParameterChange>& changes() const { return changes_; }
  const MotorCommands& commands() const { return actuators_.commands(); }
  const Saturation& saturation() const { return actuators_.saturation(); }
  bool is_armed() const { return attest::is_armed(module_, sample_); }
  float throttle() const;  // the collective thrust, 0..1 upwards

 private:
  void take(const Arrivals& arrivals, attest_inputs& in);
  void take(const Arrivals& arrivals, attest_attitude_inputs& in);
  void take(const Arrivals& arrivals, attest_rate_inputs& in);

  Module module_;
  Stimulus stimulus_;
  Actuators actuators_;
  UnitDriver driver_;
  PortFloatEnvironment ports_;
  Sample sample_{};
  Estimate estimate_;
  std::vector<ParameterChange> changes_;
};

}  // namespace attest
