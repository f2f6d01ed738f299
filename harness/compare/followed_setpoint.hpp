// The attitude and the attitude setpoint that a unit uses at each tick. Near a half turn between
// them the direction of the rotation is undefined, so comparisons allow larger deviations.
#pragma once

#include "harness/compare/tilt.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Whether the module is a unit that has an attitude law: the controller and the attitude unit.
bool follows_attitude(Module module);

// REQUIRES, for these two functions and for FollowedSetpoint: follows_attitude(module).
AttitudeQuaternion attitude_at(const Sample& tick, Module module);
// Whether the rates setpoint of the tick comes from the attitude law.
bool uses_attitude_law(const Sample& tick, Module module);

class FollowedSetpoint {
 public:
  explicit FollowedSetpoint(Module module) : module_(module) {}

  // Takes the next tick of the expected trace. Its setpoint is an input of the unit, or an output
  // that the unit computes from the sticks.
  void next(const Sample& want);
  const AttitudeQuaternion& q_d() const { return q_d_; }

 private:
  Module module_;
  bool is_first_ = true;
  AttitudeQuaternion q_d_{};  // the last setpoint that was new
};

}  // namespace attest
