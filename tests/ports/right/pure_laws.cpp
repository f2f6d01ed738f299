// A right port of the two laws alone, of all profiles, in double precision. It was written from the
// description of the law, before its author saw the reference: a second reading of the law.
//
// With FRACTION_BITS it computes with so many bits behind the point, and declares it. It then has
// no attitude law of v1.18, whose reference model multiplies small numbers with each other. With
// ATTITUDE_GAIN it is wrong: it multiplies P of the attitude law by this factor.

#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <string_view>
#include <type_traits>

#include "attest_law.h"
#include "tests/ports/right/pure_rotation.hpp"

#ifndef ATTITUDE_GAIN
#define ATTITUDE_GAIN 1.0
#endif
#define TEXT_OF(value) #value
#define AS_TEXT(value) TEXT_OF(value)

namespace {

using namespace pure;

enum class Law { v1_3, v1_5, v1_14, v1_18 };

bool find_law(std::string_view profile, Law& law) {
  const struct {
    std::string_view profile;
    Law law;
  } rows[] = {{"px4-v1.3.4", Law::v1_3},   {"px4-v1.5.5", Law::v1_5},   {"px4-v1.14.4", Law::v1_14},
              {"px4-v1.15.4", Law::v1_14}, {"px4-v1.16.0", Law::v1_14}, {"px4-v1.17", Law::v1_14},
              {"px4-v1.18", Law::v1_18}};
  for (const auto& row : rows) {
    if (row.profile != profile) continue;
    law = row.law;
    return true;
  }
  return false;
}

// ---- attitude law, v1.14 to v1.18 ---------------------------------------------------------------

using Gains = decltype(attest_attitude_law_inputs::attitude_gains);
using Setpoint = decltype(attest_attitude_law_inputs::vehicle_attitude_setpoint);

Vector rates_of_error(const Quaternion& q, const Quaternion& q_d, const Gains& gains) {
  const Number weight = clamp(gains.yaw_weight, 0.0, 1.0);
  Vector p = vector_of(gains.p) * Number(ATTITUDE_GAIN);
  if (weight > 1e-4) p[2] /= weight;

  const Number opposite = 1.0 - 1e-5;
  Quaternion reduced = between(z_axis(q), z_axis(q_d));
  const bool is_opposite = abs(reduced.v[0]) > opposite || abs(reduced.v[1]) > opposite;
  reduced = is_opposite ? q_d : reduced * q;
  const Quaternion mix = canonical(inverse(reduced) * q_d);
  const Number w = clamp(mix.w, -1.0, 1.0);
  const Number z = clamp(mix.v[2], -1.0, 1.0);
  const Quaternion yaw{cos(weight * acos(w)), {0.0, 0.0, sin(weight * asin(z))}};
  return (canonical(inverse(q) * (reduced * yaw)).v * 2.0).cwiseProduct(p);
}

// The attitude that follows the setpoints of v1.18.
class ReferenceModel {
 public:
  void take(const Setpoint& setpoint, const Gains& gains) {
    if (setpoint.timestamp <= last_us_) return;
    const Quaternion goal = unit(Quaternion::of(setpoint.q_d));
    if (last_us_ == 0) {
      q_ = goal;
      correction_ = command_ = Vector::Zero();
    } else {
      move(goal, setpoint.yaw_sp_move_rate,
           static_cast<double>(setpoint.timestamp - last_us_) * 1e-6,
           gains.ref_w_n > 0.1 ? gains.ref_w_n : 0.1);
    }
    last_us_ = setpoint.timestamp;
  }

  const Quaternion& attitude() const { return q_; }

  // In the body frame of q.
  Vector rates(const Quaternion& q, const Gains& gains) const {
    const Quaternion to_body = inverse(q) * q_;
    Vector forward = turn(to_body, correction_) * clamp(gains.ref_ff, 0.0, 1.0);
    if (gains.ref_ff_max > 0.0f) forward = clamp(forward, Vector::Constant(gains.ref_ff_max));
    return turn(to_body, command_) + forward;
  }

 private:
  void move(const Quaternion& goal, Number yaw_rate, Number dt, Number w) {
    const Quaternion inverse_q = inverse(q_);
    const Vector world_z = z_axis(inverse_q);
    command_ = isfinite(yaw_rate) ? Vector(world_z * yaw_rate) : Vector::Zero();
    const Vector error = 2.0 * canonical(inverse_q * goal).v;
    const Number k = w * dt;
    const Number decay = exp(-k);
    const Vector phi = (1.0 - (1.0 + k) * decay) * error + dt * decay * correction_ + command_ * dt;
    correction_ = w * w * dt * decay * error + (1.0 - k) * decay * correction_;
    if (isfinite(yaw_rate) && abs(yaw_rate) > epsilon) {
      correction_ -= world_z * correction_.dot(world_z);
    }
    q_ = unit(q_ * rotation(phi));
  }

  Quaternion q_;
  Vector correction_ = Vector::Zero(), command_ = Vector::Zero();
  uint64_t last_us_ = 0;
};

// ---- attitude law, v1.3 and v1.5 ----------------------------------------------------------------

Quaternion quaternion_of(const Matrix& m) {
  const Number trace = m.trace();
  if (trace > 0.0) {
    const Number s = sqrt(trace + 1.0);
    return {s / 2, Vector{m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1)} * (0.5 / s)};
  }
  int i = 0;
  for (int n = 1; n < 3; ++n) {
    if (m(n, n) > m(i, i)) i = n;
  }
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  const Number s = sqrt(m(i, i) - m(j, j) - m(k, k) + 1.0);
  Quaternion q{(m(k, j) - m(j, k)) * (0.5 / s), {}};
  q.v[i] = s / 2;
  q.v[j] = (m(i, j) + m(j, i)) * (0.5 / s);
  q.v[k] = (m(k, i) + m(i, k)) * (0.5 / s);
  return q;
}

Matrix cross_product_matrix(const Vector& v) {
  Matrix m;
  m << 0.0, -v[2], v[1], v[2], 0.0, -v[0], -v[1], v[0], 0.0;
  return m;
}

// The error as an angle about an axis [rad]: tilt, and yaw times its weight.
Vector error_angles(const Matrix& R, const Matrix& R_sp, Number yaw_weight) {
  const Number c = R.col(2).dot(R_sp.col(2));
  Vector e = R.transpose() * R.col(2).cross(R_sp.col(2));
  const Number s = e.norm();
  Matrix R_rp = R;
  if (s > 0.0) {
    const Vector axis = e / s;
    e = axis * atan2(s, c);
    const Matrix K = cross_product_matrix(axis);
    R_rp = R * (Matrix::Identity() + K * s + K * K * (1.0 - c));
  }
  const Vector x_rp = R_rp.col(0), x_sp = R_sp.col(0);
  e[2] = atan2(x_rp.cross(x_sp).dot(R_sp.col(2)), x_rp.dot(x_sp)) * yaw_weight;
  if (c < 0.0) {
    const Quaternion direct = quaternion_of(R.transpose() * R_sp);
    const Number share = c * c * yaw_weight;
    e = e * (1.0 - share) + direct.v * (direct.w >= 0.0 ? 2.0 : -2.0) * share;
  }
  return e;
}

Vector attitude_law_v1_5(Law law, const attest_attitude_law_inputs& in) {
  const Gains& gains = in.attitude_gains;
  const Matrix R_sp = matrix(Quaternion::of(in.vehicle_attitude_setpoint.q_d));
  const Number yaw_weight = R_sp(2, 2) * R_sp(2, 2);
  const Vector error =
      error_angles(matrix(Quaternion::of(in.vehicle_attitude.q)), R_sp, yaw_weight);
  Vector rates = clamp(vector_of(gains.p).cwiseProduct(error), vector_of(gains.rate_max));
  const Number vane = Number(gains.rate_max[2]) * gains.weathervane_scale;
  if (in.law.weathervane && law == Law::v1_3) rates[2] = clamp(rates[2], -vane, vane);
  rates[2] += Number(in.vehicle_attitude_setpoint.yaw_sp_move_rate) * yaw_weight * gains.yaw_ff;
  if (in.law.weathervane) rates[2] = clamp(rates[2], -vane, vane);
  return rates;
}

// ---- the modules --------------------------------------------------------------------------------

struct AttitudeLaw {
  Law law{};
  ReferenceModel model;

  Vector step(const attest_attitude_law_inputs& in) {
    if (law == Law::v1_3 || law == Law::v1_5) return attitude_law_v1_5(law, in);
    const Gains& gains = in.attitude_gains;
    const Setpoint& setpoint = in.vehicle_attitude_setpoint;
    const Quaternion q = Quaternion::of(in.vehicle_attitude.q);
    Vector rates;
    if (law == Law::v1_18) {
      model.take(setpoint, gains);
      rates = rates_of_error(q, model.attitude(), gains) + model.rates(q, gains);
    } else {
      rates = rates_of_error(q, unit(Quaternion::of(setpoint.q_d)), gains);
      const Number yaw_rate = setpoint.yaw_sp_move_rate;
      if (isfinite(yaw_rate)) rates += z_axis(inverse(q)) * yaw_rate;
    }
    return clamp(rates, vector_of(gains.rate_max));
  }
};

struct RateLaw {
  Law law{};
  Vector integral = Vector::Zero();

  Vector step(const attest_rate_law_inputs& in) {
    if (in.law.reset) integral.setZero();
    return law == Law::v1_3 || law == Law::v1_5 ? step_v1_5(in) : step_v1_14(in);
  }

 private:
  static Vector setpoint_of(const attest_rate_law_inputs& in) {
    const auto& setpoint = in.vehicle_rates_setpoint;
    return {setpoint.roll, setpoint.pitch, setpoint.yaw};
  }

  Vector step_v1_14(const attest_rate_law_inputs& in) {
    const auto& gains = in.rate_gains;
    const Vector setpoint = setpoint_of(in);
    Vector torque;
    for (int i = 0; i < 3; ++i) {
      const Number sp = setpoint[i];
      Number error = sp - in.vehicle_angular_velocity.xyz[i];
      torque[i] = gains.p[i] * error + integral[i] -
                  Number(gains.d[i]) * in.vehicle_angular_velocity.xyz_derivative[i] +
                  gains.ff[i] * sp;
      if (in.law.landed) continue;
      if (in.saturation.positive[i]) error = error < 0.0 ? error : 0.0;
      if (in.saturation.negative[i]) error = error > 0.0 ? error : 0.0;
      const Number ratio = error / (400.0 / 180.0 * std::numbers::pi);
      const Number rest = 1.0 - ratio * ratio;
      const Number sum = integral[i] + (0.0 > rest ? 0.0 : rest) * gains.i[i] * error * in.law.dt;
      if (isfinite(sum)) integral[i] = clamp(sum, -gains.integral_max[i], gains.integral_max[i]);
    }
    return torque;
  }

  Vector step_v1_5(const attest_rate_law_inputs& in) {
    const auto& gains = in.rate_gains;
    const Number thrust = in.vehicle_rates_setpoint.thrust, dt = in.law.dt;
    Number attenuation = 1.0;
    if (law == Law::v1_5) {
      const Number above = abs(thrust) - gains.tpa_break;
      attenuation = fmax(0.0, fmin(1.0, 1.0 - gains.tpa_slope * above));
    }
    const auto& limits = in.multirotor_motor_limits;
    const bool integrates = thrust > 0.2 && !limits.lower_limit && !limits.upper_limit;
    const Vector setpoint = setpoint_of(in);
    Vector torque;
    for (int i = 0; i < 3; ++i) {
      const Number sp = setpoint[i];
      const Number rate = in.vehicle_angular_velocity.xyz[i];
      const Number error = sp - rate;
      Number forward = gains.ff[i] * sp;
      if (law == Law::v1_3) forward = gains.ff[i] * (sp - in.previous.rates_sp[i]) / dt;
      torque[i] = gains.p[i] * error * attenuation +
                  gains.d[i] * (in.previous.rates[i] - rate) / dt + integral[i] + forward;
      const bool yaw_is_limited = law == Law::v1_5 && i == 2 && limits.yaw;
      if (!integrates || yaw_is_limited || !(abs(torque[i]) < thrust)) continue;
      const Number sum = integral[i] + gains.i[i] * error * dt;
      if (abs(sum) < 0.3 && abs(torque[i]) < 0.3) integral[i] = sum;
    }
    return torque;
  }
};

// ---- the ABI ------------------------------------------------------------------------------------

template <class Module>
void* create(const char* profile) {
  auto module = std::make_unique<Module>();
  if (!find_law(profile, module->law)) return nullptr;
#ifdef FRACTION_BITS
  if (std::is_same_v<Module, AttitudeLaw> && module->law == Law::v1_18) return nullptr;
#endif
  return module.release();
}

template <class Module>
void destroy(void* self) {
  delete static_cast<Module*>(self);
}

int step_attitude(void* self, const attest_attitude_law_inputs* in,
                  attest_attitude_law_outputs* out) {
  const Eigen::Vector3f rates = static_cast<AttitudeLaw*>(self)->step(*in).cast<float>();
  out->vehicle_rates_setpoint = {rates[0], rates[1], rates[2]};
  return ATTEST_OK;
}

int step_rate(void* self, const attest_rate_law_inputs* in, attest_rate_law_outputs* out) {
  auto& law = *static_cast<RateLaw*>(self);
  const Eigen::Vector3f torque = law.step(*in).cast<float>();
  for (int i = 0; i < 3; ++i) out->vehicle_torque_setpoint.xyz[i] = torque[i];
  const Eigen::Vector3f integral = law.integral.cast<float>();
  out->rate_ctrl_status = {integral[0], integral[1], integral[2]};
  return ATTEST_OK;
}

const void* extension(const char* id) {
#ifdef FRACTION_BITS
  if (std::strcmp(id, ATTEST_EXTENSION_ARITHMETIC) == 0) return "fixed:" AS_TEXT(FRACTION_BITS);
#endif
  static const attest_attitude_law attitude{create<AttitudeLaw>, destroy<AttitudeLaw>,
                                            step_attitude};
  static const attest_rate_law rate{create<RateLaw>, destroy<RateLaw>, step_rate};
  if (std::strcmp(id, ATTEST_EXTENSION_ATTITUDE_LAW) == 0) return &attitude;
  return std::strcmp(id, ATTEST_EXTENSION_RATE_LAW) == 0 ? &rate : nullptr;
}

}  // namespace

extern "C" const attest_unit* attest_unit_v1() {
  static const attest_unit unit = [] {
    attest_unit result{};
    result.abi_version = ATTEST_UNIT_ABI_VERSION;
    result.name = "right-pure-laws";
    result.version = "1.0";
    result.extension = extension;
    return result;
  }();
  return &unit;
}
