// Computes motor commands from the torque and thrust setpoints of the cascade and the positions of
// the rotors. models/README.md has the equations and their source.
//
// Body FRD. Torque and thrust are in the normalised unit of the cascade: thrust 1 is every rotor at
// full speed. A rotor's thrust and torque are taken as linear in its speed, same as in the mixer.
// allocate() has no state and does not allocate memory. Threads may share a ControlAllocator.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "harness/loop/motor_commands.hpp"
#include "harness/plant/vehicle.hpp"

namespace attest {

struct Allocation {
  MotorCommands commands{};                   // -1 where the vehicle has no rotor
  std::array<float, 3> unallocated_torque{};  // the setpoint minus the torque of the commands
  bool torque_setpoint_achieved = true;       // unallocated_torque is shorter than achieved_below
};

// The axes for which the thrust may also rise, to keep rotors from saturating: MC_AIRMODE.
enum class Airmode : std::uint8_t { off, roll_pitch, roll_pitch_yaw };

// Values other than 0, 1 and 2 act as 0.
Airmode airmode_of(double parameter);

class ControlAllocator {
 public:
  // A torque error of at most this size about an axis is taken as rounding, and counts as 0.
  static constexpr double torque_resolution = 1e-6;
  static constexpr double achieved_below = 1e-3;

  // REQUIRES: read_vehicle accepts the vehicle. The vehicle is not kept.
  explicit ControlAllocator(const Vehicle& vehicle);

  // `thrust` along body x, y, z: hover is about {0, 0, -0.5}. Rotors give no thrust along x and y,
  // so these are ignored.
  //
  // If a torque or the thrust along z is not finite, the commands of all rotors are NaN and the
  // whole torque is unallocated.
  Allocation allocate(const std::array<float, 3>& torque, const std::array<float, 3>& thrust,
                      Airmode airmode = Airmode::off) const;

 private:
  // The change of each rotor's speed for one unit of torque about an axis, or of thrust upwards.
  // Speed 1 is full speed; 0 where the vehicle has no rotor.
  //
  // Rounded to float32, because the last bits of the pseudo-inverse depend on the compiler. Stored
  // as float, because gcc 12 at -O3 left out casts from double to float and back.
  using Column = std::array<float, rotors_max>;
  using Speeds = std::array<double, rotors_max>;

  static void add(const Column& column, double amount, Speeds& speeds);
  static double way_back(const Column& column, const Speeds& speeds, double full);
  static void desaturate(const Column& column, Speeds& speeds, double full = 1);

  Speeds desaturated(const std::array<float, 3>& torque, float up, Airmode airmode) const;
  void add_yaw(float yaw, Speeds& speeds) const;
  void lower_thrust(Speeds& speeds) const;

  std::size_t count_;
  Column roll_{}, pitch_{}, yaw_{}, thrust_{};
  std::array<Column, 3> torque_{};  // torque about each axis of a rotor at full speed
};

}  // namespace attest
