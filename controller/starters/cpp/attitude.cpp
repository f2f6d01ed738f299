/* SPDX-License-Identifier: BSD-3-Clause */
#include "attitude.hpp"

#include <cmath>

#include "elementary.hpp"

namespace starter {

namespace {

// R turned about the body axis `axis` by the angle of the given sine and cosine (Rodrigues).
Mat3 turned(const Mat3& R, const Vec3& axis, float sine, float cosine) noexcept {
  const Mat3 K = {{{{{0.0f, -axis[2], axis[1]}},  //
                    {{axis[2], 0.0f, -axis[0]}},
                    {{-axis[1], axis[0], 0.0f}}}}};
  const Mat3 KK = K * K;
  return R * each_element([&](std::size_t i, std::size_t j) {
           const float identity = i == j ? 1.0f : 0.0f;
           return (identity + K(i, j) * sine) + KK(i, j) * (1.0f - cosine);
         });
}

// Twice the imaginary part of the quaternion of D, with the sign of the shorter rotation.
Vec3 direct_error(const Mat3& D) noexcept {
  const Quat q = quaternion_of(D);
  return q.w >= 0.0f ? q.im * 2.0f : conjugate(q).im * 2.0f;
}

// The rotation vector, in body axes, that takes R to R_sp: thrust axis first, then yaw. The weight
// `yaw_w` of the yaw falls as the tilt of the setpoint grows to 90 deg.
Vec3 attitude_error(const Mat3& R, const Mat3& R_sp, float yaw_w) noexcept {
  const Mat3 Rt = R.transposed();
  const Vec3 z = R.column(2);
  const Vec3 z_sp = R_sp.column(2);
  Vec3 e = Rt * cross(z, z_sp);
  const float sine = length(e);
  const float cosine = dot(z, z_sp);

  Mat3 R_rp = R;  // R with its thrust axis turned onto that of the setpoint
  if (sine > 0.0f) {
    const Vec3 axis = e / sine;
    e = axis * atan2(sine, cosine);
    R_rp = turned(R, axis, sine, cosine);
  }

  const Vec3 x_sp = R_sp.column(0);
  const Vec3 x_rp = R_rp.column(0);
  e[2] = atan2(dot(cross(x_rp, x_sp), z_sp), dot(x_rp, x_sp)) * yaw_w;

  if (cosine < 0.0f) {
    // Beyond 90 deg of tilt error the law mixes in the direct rotation.
    const Vec3 direct = direct_error(Rt * R_sp);
    const float direct_w = cosine * cosine * yaw_w;
    e = each_axis([&](std::size_t i) { return e[i] * (1.0f - direct_w) + direct[i] * direct_w; });
  }
  return e;
}

}  // namespace

Vec3 attitude_law(Profile profile, const Gains& gains, const AttitudeTask& task) noexcept {
  const Mat3 R_sp = rotation_matrix(task.q_d);
  const float yaw_w = R_sp(2, 2) * R_sp(2, 2);
  const Vec3 e = attitude_error(rotation_matrix(task.q), R_sp, yaw_w);

  const Vec3& rate_max = task.autonomous ? gains.auto_rate_max : gains.mc_rate_max;
  Vec3 rates_sp = each_axis(
      [&](std::size_t i) { return clamp(gains.att_p[i] * e[i], -rate_max[i], rate_max[i]); });

  const float vane = gains.auto_rate_max[2] * gains.weather_vane_scale;
  float& yaw = rates_sp[2];
  if (task.weather_vane && profile == Profile::px4_v1_3_4) yaw = clamp(yaw, -vane, vane);
  // Added after the limit, so the sum may exceed the limit.
  yaw += task.yaw_sp_move_rate * yaw_w * gains.yaw_ff;
  if (task.weather_vane) yaw = clamp(yaw, -vane, vane);
  return rates_sp;
}

}  // namespace starter
