/* SPDX-License-Identifier: BSD-3-Clause */
// parameters.hpp - the parameters of the law as they are set, and as the law uses them.
#ifndef ATTEST_STARTER_CPP_PARAMETERS_HPP
#define ATTEST_STARTER_CPP_PARAMETERS_HPP

#include <optional>
#include <string_view>

#include "vector.hpp"

namespace starter {

enum class Profile { px4_v1_5_5, px4_v1_3_4 };

// The profile of a name such as "px4-v1.5.5".
std::optional<Profile> profile_of(std::string_view name) noexcept;

// The parameters as set, in the units of PX4. Initialised with the defaults.
struct Parameters {
  float roll_p = 6.5f, pitch_p = 6.5f, yaw_p = 2.8f;
  float roll_tc = 0.2f, pitch_tc = 0.2f;  // [s]
  float roll_rate_p = 0.15f, roll_rate_i = 0.05f, roll_rate_d = 0.003f, roll_rate_ff = 0.0f;
  float pitch_rate_p = 0.15f, pitch_rate_i = 0.05f, pitch_rate_d = 0.003f, pitch_rate_ff = 0.0f;
  float yaw_rate_p = 0.2f, yaw_rate_i = 0.1f, yaw_rate_d = 0.0f, yaw_rate_ff = 0.0f;
  float yaw_ff = 0.5f;
  float roll_rate_max = 220.0f, pitch_rate_max = 220.0f, yaw_rate_max = 200.0f;  // [deg/s]
  float yaw_auto_max = 45.0f;                                                    // [deg/s]
  float acro_roll_max = 360.0f, acro_pitch_max = 360.0f, acro_yaw_max = 360.0f;  // [deg/s]
  float rattitude_threshold = 1.0f;
  float tpa_break = 1.0f, tpa_slope = 1.0f;
  float battery_scale_enabled = 0.0f;
  float weather_vane_scale = 0.15f;
  float vtol_type = 0.0f, recovery_enabled = 0.0f;
  float circuit_breaker = 0.0f;

  // Sets a parameter by its PX4 name. Returns whether the profile has a parameter of this name.
  bool set(Profile profile, std::string_view name, float value) noexcept;
};

// Computed from the parameters at the first step and at parameter_update. Vectors are roll, pitch,
// yaw.
struct Gains {
  Vec3 att_p;                                      // [1/s]
  Vec3 rate_p, rate_i, rate_d, rate_ff;            // control per rad/s, rad, rad/s^2, rad/s
  Vec3 mc_rate_max, auto_rate_max, acro_rate_max;  // [rad/s]
  float yaw_ff = 0.0f;
  float rattitude_threshold = 0.0f;
  float tpa_break = 0.0f, tpa_slope = 0.0f;
  float weather_vane_scale = 0.0f;
  bool battery_scale_enabled = false;
  bool circuit_breaker_open = false;

  Gains() = default;
  explicit Gains(const Parameters& parameters) noexcept;
};

}  // namespace starter

#endif  // ATTEST_STARTER_CPP_PARAMETERS_HPP
