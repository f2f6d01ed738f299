// How far the thrust axis is from where it should point: the one quantity of a sample that a
// tolerance depends on.
#pragma once

#include "harness/trace/trace.hpp"

namespace attest {

// Angle [rad] between the body z axes of the attitude in `state` and of the setpoint in `setpoint`
// (the sample in which the setpoint was last published), in double. Not a number when either
// quaternion is not finite or zero.
double tilt_error(const attest_inputs& state, const attest_inputs& setpoint);

// The larger of the roll and pitch attitude gains [1/s], without their signs, as parameters are
// set.
class AttitudeGain {
 public:
  void set(const ParameterChange& change);
  double value() const;

 private:
  // Defaults of PX4 v1.5.5: MC_{ROLL,PITCH}_P and MC_{ROLL,PITCH}_TC.
  double roll_p_ = 6.5, roll_tc_ = 0.2, pitch_p_ = 6.5, pitch_tc_ = 0.2;
};

}  // namespace attest
