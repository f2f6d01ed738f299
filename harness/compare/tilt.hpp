// The tilt error: the angle between the thrust axis and its setpoint. The tolerance of rates
// setpoints is wider where it is near 180 deg.
#pragma once

#include "harness/trace/trace.hpp"

namespace attest {

// Angle [rad] between the body z axes of the attitude in `state` and of the setpoint in `setpoint`
// (the sample in which the setpoint was last published), in double. NaN when a quaternion is zero
// or not finite.
double tilt_error(const attest_inputs& state, const attest_inputs& setpoint);

// The larger of the roll and pitch attitude gains [1/s], without their signs. It follows the
// parameter changes.
class AttitudeGain {
 public:
  void set(const ParameterChange& change);
  double value() const;

 private:
  // Defaults of PX4 v1.5.5: MC_{ROLL,PITCH}_P and MC_{ROLL,PITCH}_TC.
  double roll_p_ = 6.5, roll_tc_ = 0.2, pitch_p_ = 6.5, pitch_tc_ = 0.2;
};

}  // namespace attest
