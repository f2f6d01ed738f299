// The attitude error that a rates setpoint corrects. The tolerance of rates setpoints is wider
// where this error is near 180 deg.
#pragma once

#include <array>

#include "harness/trace/trace.hpp"

namespace attest {

using AttitudeQuaternion = std::array<double, 4>;  // w, x, y, z, of any norm

// Angle [rad] between the body z axes of two attitudes, in double. NaN when a quaternion is zero or
// not finite.
double tilt_error(const AttitudeQuaternion& q, const AttitudeQuaternion& q_d);

// Angle [rad] of the rotation between two attitudes: near 180 deg if the tilt error or the yaw
// error is. NaN when a quaternion is zero or not finite.
double attitude_error(const AttitudeQuaternion& q, const AttitudeQuaternion& q_d);

// The largest attitude gain [1/s], without its sign: of roll and pitch in the controller, also of
// yaw in the cascade. set() takes each change of a parameter.
class AttitudeGain {
 public:
  explicit AttitudeGain(Module module);
  void set(const ParameterChange& change);
  double value() const;

 private:
  Module module_;
  // The defaults of PX4: roll and pitch are those of v1.5.5 and of the cascade, yaw is of the
  // cascade.
  double roll_p_ = 6.5, roll_tc_ = 0.2, pitch_p_ = 6.5, pitch_tc_ = 0.2;
  double yaw_p_ = 2.8, yaw_weight_ = 0.4;
};

}  // namespace attest
