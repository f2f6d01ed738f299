// The commands to the motors, and what the actuators could not realise.
#pragma once

#include <array>

#include "controller/attest_unit.h"
#include "harness/plant/vehicle.hpp"

namespace attest {

// One per rotor, from -1 (stopped) to 1 (full).
using MotorCommands = std::array<float, rotors_max>;

// Each flag is 0, or its own bit of the firmware's mask (1, 2 or 4). Any value but 0 is true.
using MotorLimits = decltype(attest_inputs::multirotor_motor_limits);

// What the actuators could not realise in the last run of the mixer or the allocator. The mixer
// sets `limits`, for the controller. The allocator sets the other two members, for the rate unit.
struct Saturation {
  MotorLimits limits{};
  std::array<float, 3> unallocated_torque{};
  bool torque_setpoint_achieved = true;

  bool any() const {
    return (limits.lower_limit | limits.upper_limit | limits.yaw) != 0 || !torque_setpoint_achieved;
  }
};

}  // namespace attest
