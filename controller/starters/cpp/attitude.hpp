/* SPDX-License-Identifier: BSD-3-Clause */
// attitude.hpp - the outer loop: attitude error to rates setpoint.
#ifndef ATTEST_STARTER_CPP_ATTITUDE_HPP
#define ATTEST_STARTER_CPP_ATTITUDE_HPP

#include "parameters.hpp"
#include "vector.hpp"

namespace starter {

struct AttitudeTask {
  Quat q, q_d;                    // attitude and its setpoint, body to world
  float yaw_sp_move_rate = 0.0f;  // [rad/s] fed forward
  bool autonomous = false;        // selects the limits of the rates
  bool weather_vane = false;      // the wind may turn the nose
};

// Returns the rates setpoint [rad/s]. With `weather_vane` the caller also zeroes the yaw integral.
Vec3 attitude_law(Profile profile, const Gains& gains, const AttitudeTask& task) noexcept;

}  // namespace starter

#endif  // ATTEST_STARTER_CPP_ATTITUDE_HPP
