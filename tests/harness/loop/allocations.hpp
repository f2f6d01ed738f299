// What the control allocator is compared with: a second program for its equations, and a simpler
// allocator.
#pragma once

#include <array>

#include <Eigen/Core>

#include "harness/loop/control_allocator.hpp"

namespace attest::test {

// The mix and the torque of a vehicle, as models/README.md describes them. All in double.
class AllocationModel {
 public:
  explicit AllocationModel(const Vehicle& vehicle);

  // Speeds of the rotors, 0..1. The torque is about body x, y, z, the thrust is upwards.
  using Speeds = Eigen::ArrayXd;
  using Torque = Eigen::Array3d;

  // By sequential desaturation.
  Speeds sequential(const Torque& torque, double thrust, Airmode airmode) const;

  // By scaling: the largest part of roll and pitch together that fits, then the largest part of
  // yaw. attest had this allocator first. MC_AIRMODE has no effect on it.
  Speeds scaled(const Torque& torque, double thrust) const;

  // A rotor would have to exceed its limits for this setpoint.
  bool saturates(const Torque& torque, double thrust) const;

  // The sign of the torque about each axis that these speeds lack, 0 for no flag: the saturation
  // flags of the rate unit.
  std::array<int, 3> flags(const Torque& torque, const Speeds& speeds) const;

 private:
  Speeds mixed(const Torque& torque, double thrust) const;

  Eigen::ArrayX4d mix_;         // roll, pitch, yaw, thrust; one row for each rotor
  Eigen::Matrix3Xd torque_of_;  // of one rotor at full speed
};

}  // namespace attest::test
