/* SPDX-License-Identifier: BSD-3-Clause */
#include "tailsitter.hpp"

#include <cmath>

#include "elementary.hpp"

namespace starter {

namespace {

constexpr float half_pi = pi / 2.0f;

// A value times the logistic function of v. It is one division, as in the recorded firmware: a
// product with 1 / (1 + exp(-v)) has other last bits.
float times_sigmoid(float value, float v) noexcept { return value / (1.0f + exp(-v)); }

struct Tilt {
  float angle = 0.0f;      // [rad] between the thrust axis and that of the setpoint
  float direction = 0.0f;  // [rad] of the tilt axis in the body's x-y plane, counted from y
};

Tilt tilt_of(const AttitudeTask& task, const Mat3& R) noexcept {
  const Vec3 z_B = {{0.0f, 0.0f, -1.0f}};
  const Vec3 z_I = rotation_matrix(task.q * conjugate(task.q_d)) * z_B;
  const float cosine = dot(z_I, z_B);
  Tilt tilt;
  tilt.angle = acos(cosine);
  if (cosine >= 1.0f) tilt.angle = 0.0f;
  if (cosine <= -1.0f) tilt.angle = pi;
  const float to_parallel = std::fmin(std::fabs(tilt.angle), std::fabs(tilt.angle - pi));
  const Vec3 axis = R.transposed() * (to_parallel > 1e-5f ? cross(z_I, z_B) : z_B);
  tilt.direction = atan2(axis[0], axis[1]);
  return tilt;
}

struct Quadrant {
  float direction;  // [rad] folded into 0 .. pi/2
  Vec3 sign;        // of each rate
};

// The fit covers one quadrant of tilt directions. The others follow by symmetry.
Quadrant folded(float direction) noexcept {
  if (direction < -half_pi) return {direction + pi, {{-1.0f, -1.0f, 1.0f}}};
  if (direction < 0.0f) return {-direction, {{-1.0f, 1.0f, -1.0f}}};
  if (direction < half_pi) return {direction, {{1.0f, 1.0f, 1.0f}}};
  return {pi - direction, {{1.0f, -1.0f, -1.0f}}};
}

Vec3 recovery_rates(const Tilt& tilt) noexcept {
  const auto [direction, sign] = folded(tilt.direction);
  const float x = tilt.angle;
  const float y = half_pi - direction;
  const float share = y / half_pi;
  const float roll = -3.997f * x + share * share * times_sigmoid(3.997f * x, 4.013f * (2.133f - x));
  const float pitch =
      (1.38f * y + 0.8725f * (y * y)) *
      (times_sigmoid(-1.676f * x, 2.642f * (0.3586f - x)) +
       times_sigmoid(1.676f * x * exp(2.642f * (0.3586f - pi)), 2.642f * (pi - 0.3586f)));
  const float yaw =
      (3.168f * y - 0.3913f * (y * y)) * (times_sigmoid(2.726f * (x - pi), 2.298f * (x - 1.75f)) -
                                          times_sigmoid(2.726f * (x - pi), -1.75f * 2.298f));
  return {{roll * -sign[0], pitch * (-sign[1] * 1.5f), yaw * -sign[2]}};
}

// Without a recovery: rates proportional to the imaginary part of the rotation to the setpoint.
Vec3 hold_rates(const Gains& gains, const AttitudeTask& task) noexcept {
  const Quat q_e = conjugate(task.q_d) * task.q;
  const float factor = q_e.w > 0.0f ? -2.0f : 2.0f;
  Vec3 rates = each_axis([&](std::size_t i) { return gains.att_p[i] * (q_e.im[i] * factor); });
  rates[2] = clamp(rates[2], -1.0f, 1.0f);
  return rates;
}

}  // namespace

Vec3 TailsitterLoop::update(const Gains& gains, const AttitudeTask& task) noexcept {
  const Mat3 R = rotation_matrix(task.q);
  const Tilt tilt = tilt_of(task, R);
  if (std::fabs(tilt.angle) > rad(30.0f)) {
    recovering_ = true;
  } else if (std::fabs(tilt.angle) < rad(5.0f)) {
    recovering_ = false;
  }
  Vec3 rates = recovering_ ? recovery_rates(tilt) : hold_rates(gains, task);
  const float upright = clamp(std::fmax(R(2, 2), 0.0f), 0.0f, 1.0f);
  rates[2] += task.yaw_sp_move_rate * upright * gains.yaw_ff;
  return each_axis(
      [&](std::size_t i) { return clamp(rates[i], -gains.mc_rate_max[i], gains.mc_rate_max[i]); });
}

}  // namespace starter
