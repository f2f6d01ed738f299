// From the unit's controls to the commanded rotor speeds: mixer, arming, battery voltage, motor
// failure. No allocation after construction.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "controller/actuation/mixer.hpp"
#include "controller/attest_unit.h"
#include "harness/core/result.hpp"
#include "harness/plant/vehicle.hpp"

namespace attest {

// One per rotor, from -1 (stopped) to 1 (full).
using MotorCommands = std::array<float, rotors_max>;

// Flags as the firmware sends them: bits of one mask, so any value but 0 is true.
using MotorLimits = decltype(attest_inputs::multirotor_motor_limits);

class Actuators {
 public:
  // REQUIRES: the vehicle outlives this, and its mixer can be parsed (read_vehicle checks).
  explicit Actuators(const Vehicle& vehicle);

  // The mixer runs when the unit publishes actuator controls. Disarmed motors stop.
  void mix(const attest_outputs& out, bool armed);

  const MotorCommands& commands() const { return commands_; }
  const MotorLimits& limits() const { return limits_; }  // of the mixer's last run

  // The speeds [rad/s] for `commands`, one per rotor, valid until the next call. They are linear in
  // the command, times the `supply` ratio of the battery, and 0 for the `failed` rotor. Empty when
  // a command is not finite.
  std::span<const double> speeds(const MotorCommands& commands, double supply,
                                 const std::optional<std::size_t>& failed);

 private:
  const Vehicle& vehicle_;
  actuation::Mixer mixer_;
  MotorCommands commands_{};
  MotorLimits limits_{};
  std::array<double, rotors_max> speeds_{};
};

}  // namespace attest
