/* SPDX-License-Identifier: BSD-3-Clause */
#include "control.hpp"

#include <algorithm>
#include <utility>

namespace mc {

namespace {

constexpr float kIntegralLimit = 0.3f;
constexpr float kMinTakeoffThrust = 0.2f;

Vec3 limit(const Vec3& v, const Vec3& bound) {
  Vec3 out;
  for (std::size_t i = 0; i < 3; ++i) out[i] = clamp(v[i], -bound[i], bound[i]);
  return out;
}

// The rotation vector, in body axes, from R to R_sp: thrust axis first, then yaw by its weight.
Vec3 attitude_error(const Mat3& R, const Mat3& R_sp, float yaw_w) {
  const Mat3 Rt = R.transposed();
  const Vec3 z = R.col(2);
  const Vec3 z_sp = R_sp.col(2);
  Vec3 e = Rt * z.cross(z_sp);
  const float sine = e.norm();
  const float cosine = z.dot(z_sp);

  Mat3 R_rp = R;
  if (sine > 0.0f) {
    const Vec3 axis = e / sine;
    e = axis * std::atan2(sine, cosine);
    const Mat3 K = Mat3::skew(axis);
    R_rp = R * ((Mat3::identity() + K * sine) + (K * K) * (1.0f - cosine));
  }

  const Vec3 x_sp = R_sp.col(0);
  const Vec3 x_rp = R_rp.col(0);
  e[2] = std::atan2(x_rp.cross(x_sp).dot(z_sp), x_rp.dot(x_sp)) * yaw_w;

  if (cosine < 0.0f) {
    const Quat q_e(Rt * R_sp);
    const Vec3 direct = (q_e.w >= 0.0f ? q_e.imag() : -q_e.imag()) * 2.0f;
    const float direct_w = cosine * cosine * yaw_w;
    e = e * (1.0f - direct_w) + direct * direct_w;
  }
  return e;
}

float sigmoid(float v) { return 1.0f / (1.0f + std::exp(-v)); }

// Rates that undo a tilt [rad] about the direction [rad] in body x-y, counted from y.
Vec3 recovery_rates(float tilt, float direction) {
  Vec3 sign(1.0f, 1.0f, 1.0f);
  if (direction < -kPi / 2.0f) {
    direction += kPi;
    sign = {-1.0f, -1.0f, 1.0f};
  } else if (direction < 0.0f) {
    direction = -direction;
    sign = {-1.0f, 1.0f, -1.0f};
  } else if (!(direction < kPi / 2.0f)) {
    direction = kPi - direction;
    sign = {1.0f, -1.0f, -1.0f};
  }
  const float x = tilt;
  const float y = kPi / 2.0f - direction;
  const float share = y / (kPi / 2.0f);
  const float roll = -3.997f * x + share * share * (3.997f * x * sigmoid(4.013f * (2.133f - x)));
  const float pitch =
      (1.38f * y + 0.8725f * y * y) *
      (-1.676f * x * sigmoid(2.642f * (0.3586f - x)) +
       1.676f * x * std::exp(2.642f * (0.3586f - kPi)) * sigmoid(2.642f * (kPi - 0.3586f)));
  const float yaw =
      (3.168f * y - 0.3913f * y * y) * (2.726f * (x - kPi) * sigmoid(2.298f * (x - 1.75f)) -
                                        2.726f * (x - kPi) * sigmoid(-1.75f * 2.298f));
  return {roll * -sign[0], pitch * (-sign[1] * 1.5f), yaw * -sign[2]};
}

// Tilt [rad] between the thrust axes, and its direction.
std::pair<float, float> tilt_and_direction(const Quat& q, const Quat& q_sp, const Mat3& R) {
  const Vec3 z_body(0.0f, 0.0f, -1.0f);
  const Vec3 z_inertial = (q * q_sp.conjugate()).to_dcm() * z_body;
  const float cosine = z_inertial.dot(z_body);
  const bool defined = cosine > -1.0f && cosine < 1.0f;
  const float tilt = defined ? std::acos(cosine) : (cosine > 0.0f ? 0.0f : kPi);
  Vec3 axis = z_body;
  if (std::min(std::fabs(tilt), std::fabs(tilt - kPi)) > 1e-5f) axis = z_inertial.cross(z_body);
  axis = R.transposed() * axis;
  return {tilt, std::atan2(axis[0], axis[1])};
}

}  // namespace

Vec3 AttitudeControl::update(const AttitudeDemand& demand, const Gains& gains) const {
  const Mat3 R = demand.q.to_dcm();
  const Mat3 R_sp = demand.q_sp.to_dcm();
  const float yaw_w = R_sp(2, 2) * R_sp(2, 2);
  const Vec3 e = attitude_error(R, R_sp, yaw_w);
  Vec3 rates_sp = limit(gains.attitude_p.emult(e),
                        demand.use_auto_limit ? gains.auto_rate_max : gains.rate_max);
  const float vane = gains.auto_rate_max[2] * gains.weather_vane_scale;
  if (demand.weather_vane && law_ == Law::v1_3_4) rates_sp[2] = clamp(rates_sp[2], -vane, vane);
  rates_sp[2] += demand.yaw_rate_feed_forward * yaw_w * gains.yaw_ff;
  if (demand.weather_vane) rates_sp[2] = clamp(rates_sp[2], -vane, vane);
  return rates_sp;
}

Vec3 TailsitterRecovery::update(const AttitudeDemand& demand, const Gains& gains) {
  const Mat3 R = demand.q.to_dcm();
  const auto [tilt, direction] = tilt_and_direction(demand.q, demand.q_sp, R);
  if (std::fabs(tilt) > radians(30.0f)) {
    recovering_ = true;
  } else if (std::fabs(tilt) < radians(5.0f)) {
    recovering_ = false;
  }
  Vec3 rates_sp;
  if (recovering_) {
    rates_sp = recovery_rates(tilt, direction);
  } else {
    const Quat q_e = demand.q_sp.conjugate() * demand.q;
    rates_sp = gains.attitude_p.emult(q_e.imag()) * (q_e.w > 0.0f ? -2.0f : 2.0f);
    rates_sp[2] = clamp(rates_sp[2], -1.0f, 1.0f);
  }
  const float upright = clamp(std::fmax(R(2, 2), 0.0f), 0.0f, 1.0f);
  rates_sp[2] += demand.yaw_rate_feed_forward * upright * gains.yaw_ff;
  return limit(rates_sp, gains.rate_max);
}

Vec3 RateControl::update(const RateDemand& demand, const Gains& gains, float dt) {
  const float attenuation =
      1.0f - gains.tpa_slope * (std::fabs(demand.thrust_for_tpa) - gains.tpa_break);
  // fmin and fmax drop a NaN: a thrust that is NaN does not attenuate.
  const float tpa = law_ == Law::v1_3_4 ? 1.0f : std::fmax(0.0f, std::fmin(1.0f, attenuation));
  const Vec3 error = demand.rates_sp - demand.rates;
  const Vec3 p = gains.rate_p.emult(error * tpa);
  const Vec3 d = gains.rate_d.emult(rates_prev_ - demand.rates) / dt;
  const Vec3 ff = law_ == Law::v1_3_4 ? gains.rate_ff.emult(demand.rates_sp - rates_sp_prev_) / dt
                                      : gains.rate_ff.emult(demand.rates_sp);
  const Vec3 control = ((p + d) + integral_) + ff;
  rates_prev_ = demand.rates;
  rates_sp_prev_ = demand.rates_sp;
  integrate(demand, gains.rate_i.emult(error) * dt, control);
  return control;
}

void RateControl::integrate(const RateDemand& demand, const Vec3& increment, const Vec3& control) {
  if (!demand.may_integrate || !(demand.thrust_sp > kMinTakeoffThrust)) return;
  for (std::size_t i = 0; i < 3; ++i) {
    const bool frozen = i == 2 && demand.yaw_saturated && law_ == Law::v1_5_5;
    const float next = integral_[i] + increment[i];
    if (std::fabs(control[i]) < demand.thrust_sp && std::isfinite(next) &&
        std::fabs(next) < kIntegralLimit && std::fabs(control[i]) < kIntegralLimit && !frozen) {
      integral_[i] = next;
    }
  }
}

}  // namespace mc
