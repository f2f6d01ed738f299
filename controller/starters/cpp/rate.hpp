/* SPDX-License-Identifier: BSD-3-Clause */
// rate.hpp - the inner loop: rate error to controls, with the integrals as its state.
#ifndef ATTEST_STARTER_CPP_RATE_HPP
#define ATTEST_STARTER_CPP_RATE_HPP

#include "parameters.hpp"
#include "vector.hpp"

namespace starter {

struct RateTask {
  Vec3 rates_sp, rates;          // [rad/s]
  float thrust_sp = 0.0f;        // decides when the integrals may move
  float tpa_thrust = 0.0f;       // of the copy of vehicle_rates_setpoint
  bool motors_at_limit = false;  // the lower or the upper limit
  bool yaw_at_limit = false;
};

class RateLoop {
 public:
  explicit RateLoop(Profile profile) noexcept : profile_(profile) {}

  // Returns the controls of roll, pitch and yaw, which may be NaN or infinite, and updates the
  // integrals. `dt` in [s], not 0.
  Vec3 update(const Gains& gains, const RateTask& task, float dt) noexcept;

  void reset_integrals() noexcept { integrals_ = {}; }
  void reset_yaw_integral() noexcept { integrals_[2] = 0.0f; }
  const Vec3& integrals() const noexcept { return integrals_; }

 private:
  Vec3 feed_forward(const Gains& gains, const Vec3& rates_sp, float dt) const noexcept;
  void integrate(const Gains& gains, const RateTask& task, const Vec3& error, const Vec3& control,
                 float dt) noexcept;

  Profile profile_;
  Vec3 rates_prev_;
  Vec3 rates_sp_prev_;  // px4-v1.3.4 only: its feed-forward acts on the change
  Vec3 integrals_;
};

}  // namespace starter

#endif  // ATTEST_STARTER_CPP_RATE_HPP
