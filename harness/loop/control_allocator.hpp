// Computes motor commands from the torque and thrust setpoints of the cascade and the positions of
// the rotors. models/README.md has the equations and their reasons.
//
// Body FRD. Torque and thrust are in the normalised unit of the cascade: thrust 1 is every rotor at
// full speed. A rotor's thrust and torque are taken as linear in its speed, same as in the mixer.
// allocate() has no state and does not allocate memory. Threads may share a ControlAllocator.
#pragma once

#include <array>
#include <cstddef>

#include "harness/loop/motor_commands.hpp"
#include "harness/plant/vehicle.hpp"

namespace attest {

struct Allocation {
  MotorCommands commands{};                   // -1 where the vehicle has no rotor
  std::array<float, 3> unallocated_torque{};  // the setpoint minus the torque of the commands
  bool torque_setpoint_achieved = true;       // unallocated_torque is 0 about all axes
};

class ControlAllocator {
 public:
  // A torque error of at most this size is taken as rounding, and counts as 0.
  static constexpr float torque_resolution = 1e-6f;

  // REQUIRES: read_vehicle accepts the vehicle. The vehicle is not kept.
  explicit ControlAllocator(const Vehicle& vehicle);

  // `thrust` along body x, y, z: hover is about {0, 0, -0.5}. Rotors give no thrust along x and y,
  // so these are ignored. Thrust downwards counts as 0.
  //
  // If a torque or the thrust along z is not finite, the commands of all rotors are NaN and the
  // whole torque is unallocated.
  Allocation allocate(const std::array<float, 3>& torque, const std::array<float, 3>& thrust) const;

 private:
  // One rotor in the mix. Speed 1 is full speed.
  //
  // The members are rounded to float32, because the last bits of the pseudo-inverse depend on the
  // compiler. They are stored as float, because gcc 12 at -O3 left out casts from double to float
  // and back.
  struct Rotor {
    float roll = 0, pitch = 0, yaw = 0;  // speed for one unit of torque
    float thrust = 1;                    // speed for one unit of collective thrust
    std::array<float, 3> torque{};       // at full speed
  };

  // Speeds, or changes of them, each divided by Rotor::thrust: in this unit, a change of the
  // collective thrust is the same for all rotors.
  using Speeds = std::array<double, rotors_max>;

  Speeds roll_pitch_turns(double roll, double pitch) const;
  Speeds with_roll_pitch(Speeds turns, double thrust) const;
  Speeds with_yaw(double yaw, Speeds speeds) const;
  double part_that_fits(const Speeds& yaw_turns, const Speeds& speeds) const;
  double full(std::size_t rotor) const { return 1 / static_cast<double>(rotors_[rotor].thrust); }

  std::size_t count_;
  std::array<Rotor, rotors_max> rotors_{};
};

}  // namespace attest
