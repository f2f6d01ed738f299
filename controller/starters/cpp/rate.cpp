/* SPDX-License-Identifier: BSD-3-Clause */
#include "rate.hpp"

#include <cmath>

namespace starter {

namespace {

constexpr float min_takeoff_thrust = 0.2f;  // up to it, the vehicle may stand on the ground
constexpr float integral_limit = 0.3f;

// Returns false for NaN.
bool inside_integral_limit(float v) noexcept { return -integral_limit < v && v < integral_limit; }

// Thrust-based attenuation of the P gain. fmin and fmax ignore a NaN: NaN thrust gives 1.
float attenuation(const Gains& gains, float thrust) noexcept {
  const float factor = 1.0f - gains.tpa_slope * (std::fabs(thrust) - gains.tpa_break);
  return std::fmax(0.0f, std::fmin(1.0f, factor));
}

}  // namespace

Vec3 RateLoop::feed_forward(const Gains& gains, const Vec3& rates_sp, float dt) const noexcept {
  const Vec3& ff = gains.rate_ff;
  return each_axis([&](std::size_t i) {
    if (profile_ == Profile::px4_v1_3_4) return ff[i] * (rates_sp[i] - rates_sp_prev_[i]) / dt;
    return ff[i] * rates_sp[i];
  });
}

void RateLoop::integrate(const Gains& gains, const RateTask& task, const Vec3& error,
                         const Vec3& control, float dt) noexcept {
  if (!(task.thrust_sp > min_takeoff_thrust) || task.motors_at_limit) return;
  const bool yaw_frozen = profile_ != Profile::px4_v1_3_4 && task.yaw_at_limit;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(std::fabs(control[i]) < task.thrust_sp) || (i == 2 && yaw_frozen)) continue;
    const float next = integrals_[i] + gains.rate_i[i] * error[i] * dt;
    if (inside_integral_limit(next) && inside_integral_limit(control[i])) integrals_[i] = next;
  }
}

Vec3 RateLoop::update(const Gains& gains, const RateTask& task, float dt) noexcept {
  const float tpa = profile_ == Profile::px4_v1_3_4 ? 1.0f : attenuation(gains, task.tpa_thrust);
  const Vec3 error = task.rates_sp - task.rates;
  const Vec3 ff = feed_forward(gains, task.rates_sp, dt);
  const Vec3 control = each_axis([&](std::size_t i) {
    const float p = gains.rate_p[i] * (error[i] * tpa);
    const float d = gains.rate_d[i] * (rates_prev_[i] - task.rates[i]) / dt;
    return ((p + d) + integrals_[i]) + ff[i];
  });
  rates_prev_ = task.rates;
  rates_sp_prev_ = task.rates_sp;
  integrate(gains, task, error, control, dt);
  return control;
}

}  // namespace starter
