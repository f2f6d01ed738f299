/* SPDX-License-Identifier: BSD-3-Clause */
// control.hpp - the loops of the multicopter attitude controller, profiles px4-v1.5.5 and -v1.3.4.
//
// Rates are rad/s about body x, y, z (FRD), `dt` is in seconds and never 0.
#ifndef ATTEST_TESTS_PORTS_MISTAKES_CONTROL_HPP
#define ATTEST_TESTS_PORTS_MISTAKES_CONTROL_HPP

#include "linear.hpp"

namespace mc {

enum class Law { v1_5_5, v1_3_4 };

// What the loops use, made of the parameters.
struct Gains {
  Vec3 attitude_p, rate_p, rate_i, rate_d, rate_ff;
  Vec3 rate_max, auto_rate_max, acro_rate_max;  // [rad/s]
  float yaw_ff = 0.0f, rattitude_threshold = 0.0f, weather_vane_scale = 0.0f;
  float tpa_break = 0.0f, tpa_slope = 0.0f;
  bool scale_by_battery = false;
  bool circuit_breaker = false;
};

struct AttitudeDemand {
  Quat q, q_sp;                        // body to world
  float yaw_rate_feed_forward = 0.0f;  // [rad/s]
  bool use_auto_limit = false;
  bool weather_vane = false;
};

// Outer loop: attitude error to rates setpoint.
class AttitudeControl {
 public:
  explicit AttitudeControl(Law law) : law_(law) {}

  Vec3 update(const AttitudeDemand& demand, const Gains& gains) const;

 private:
  Law law_;
};

// Outer loop of a tailsitter, which recovers from a large tilt along precomputed rates.
class TailsitterRecovery {
 public:
  Vec3 update(const AttitudeDemand& demand, const Gains& gains);

 private:
  bool recovering_ = false;
};

struct RateDemand {
  Vec3 rates_sp, rates;
  float thrust_sp = 0.0f;       // decides when the integrals may move
  float thrust_for_tpa = 0.0f;  // of the rates setpoint as last published or received
  bool may_integrate = false;   // neither the lower nor the upper motor limit is reached
  bool yaw_saturated = false;
};

// Inner loop: rate error to controls.
class RateControl {
 public:
  explicit RateControl(Law law) : law_(law) {}

  Vec3 update(const RateDemand& demand, const Gains& gains, float dt);
  void reset_integral() { integral_ = {}; }
  void reset_yaw_integral() { integral_[2] = 0.0f; }
  const Vec3& integral() const { return integral_; }

 private:
  void integrate(const RateDemand& demand, const Vec3& increment, const Vec3& control);

  Law law_;
  Vec3 rates_prev_, rates_sp_prev_, integral_;
};

}  // namespace mc

#endif  // ATTEST_TESTS_PORTS_MISTAKES_CONTROL_HPP
