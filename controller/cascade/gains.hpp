// The gains, limits in radians and stick curves. The law computes them whenever it reads the
// parameters.
//
// Vectors are in the order roll, pitch, yaw. Plain values; any thread.
#pragma once

#include "controller/cascade/parameters.hpp"
#include "controller/cascade/rotation.hpp"
#include "controller/cascade/scalar_math.hpp"

namespace attest::cascade {

template <typename Scalar>
struct AttitudeGains {
  Vector3<Scalar> proportional_1_s;  // rate setpoint for each radian of error
  Vector3<Scalar> rate_max_rad_s;
  Scalar yaw_weight;  // 0..1
};

enum class ThrottleCurve { through_hover_estimate, straight, through_hover_parameter };

template <typename Scalar>
struct StickGains {
  Scalar tilt_max_rad;
  Scalar tilt_tau_s;
  Scalar yaw_rate_max_rad_s;
  Scalar yaw_tau_s;
  Scalar yaw_deadzone;
  Scalar yaw_expo;
  Scalar thrust_min;  // MPC_MANTHR_MIN
  Scalar thrust_hover;
  Scalar thrust_max;
  ThrottleCurve throttle_curve;
  bool yaws_at_lowest_throttle;
};

template <typename Scalar>
struct ReferenceModelGains {
  Scalar natural_rad_s;           // natural frequency
  Scalar feed_forward;            // 0..1
  Scalar feed_forward_max_rad_s;  // 0: no limit
};

template <typename Scalar>
struct AttitudeUnitGains {
  AttitudeGains<Scalar> attitude;
  ReferenceModelGains<Scalar> model;
  StickGains<Scalar> sticks;
  Scalar spoolup_us;
};

template <typename Scalar>
struct RateGains {
  Vector3<Scalar> proportional;
  Vector3<Scalar> integral;
  Vector3<Scalar> derivative;
  Vector3<Scalar> feed_forward;
  Vector3<Scalar> integral_max;
};

template <typename Scalar>
struct AcroGains {
  Vector3<Scalar> rate_max_rad_s;
  Vector3<Scalar> expo;
  Vector3<Scalar> superexpo;
};

template <typename Scalar>
struct RateUnitGains {
  RateGains<Scalar> rate;
  AcroGains<Scalar> acro;
  Scalar yaw_torque_tau_s;
  bool battery_scaling;
};

template <typename Scalar>
Vector3<Scalar> each(float roll, float pitch, float yaw) {
  return {Scalar(roll), Scalar(pitch), Scalar(yaw)};
}

template <typename Scalar>
Vector3<Scalar> radians_each(float roll_deg, float pitch_deg, float yaw_deg) {
  return {radians(Scalar(roll_deg)), radians(Scalar(pitch_deg)), radians(Scalar(yaw_deg))};
}

// The yaw gain is divided by the weight, because the law multiplies the yaw error by the weight:
// the product is MC_YAW_P again. A weight of at most 1e-4 leaves the gain unchanged.
template <typename Scalar>
Scalar weighted_yaw_gain(Scalar gain, Scalar weight) {
  return weight > Scalar(1e-4f) ? gain / weight : gain;
}

// The curve that MPC_THR_CURVE selects. Values other than 1 and 2 mean the same as 0.
inline ThrottleCurve throttle_curve(float value) {
  if (value == 1.0f) return ThrottleCurve::straight;
  return value == 2.0f ? ThrottleCurve::through_hover_parameter
                       : ThrottleCurve::through_hover_estimate;
}

template <typename Scalar>
AttitudeUnitGains<Scalar> attitude_unit_gains(const Parameters& p) {
  AttitudeUnitGains<Scalar> gains;
  AttitudeGains<Scalar>& attitude = gains.attitude;
  attitude.yaw_weight = clamp(Scalar(p.mc_yaw_weight), Scalar(0), Scalar(1));
  attitude.proportional_1_s = each<Scalar>(p.mc_roll_p, p.mc_pitch_p, p.mc_yaw_p);
  attitude.proportional_1_s[2] =
      weighted_yaw_gain(attitude.proportional_1_s[2], attitude.yaw_weight);
  attitude.rate_max_rad_s =
      radians_each<Scalar>(p.mc_rollrate_max, p.mc_pitchrate_max, p.mc_yawrate_max);

  StickGains<Scalar>& sticks = gains.sticks;
  sticks.tilt_max_rad = radians(Scalar(p.mpc_man_tilt_max));
  sticks.tilt_tau_s = Scalar(p.mc_man_tilt_tau);
  sticks.yaw_rate_max_rad_s = radians(Scalar(p.mpc_man_y_max));
  sticks.yaw_tau_s = Scalar(p.mpc_man_y_tau);
  sticks.yaw_deadzone = Scalar(p.man_deadzone);
  sticks.yaw_expo = Scalar(p.mpc_yaw_expo);
  sticks.thrust_min = Scalar(p.mpc_manthr_min);
  sticks.thrust_hover = Scalar(p.mpc_thr_hover);
  sticks.thrust_max = Scalar(p.mpc_thr_max);
  sticks.throttle_curve = throttle_curve(p.mpc_thr_curve);
  sticks.yaws_at_lowest_throttle = p.mc_airmode == 2.0f;

  gains.model.natural_rad_s = max(Scalar(p.mc_ref_w_n), Scalar(0.1f));
  gains.model.feed_forward = clamp(Scalar(p.mc_ref_ff), Scalar(0), Scalar(1));
  gains.model.feed_forward_max_rad_s = max(radians(Scalar(p.mc_ref_ff_max)), Scalar(0));
  gains.spoolup_us = Scalar(p.com_spoolup_time) * Scalar(1e6f);
  return gains;
}

template <typename Scalar>
RateUnitGains<Scalar> rate_unit_gains(const Parameters& p) {
  RateUnitGains<Scalar> gains;
  const Vector3<Scalar> k = each<Scalar>(p.mc_rollrate_k, p.mc_pitchrate_k, p.mc_yawrate_k);
  const auto scaled = [&k](float roll, float pitch, float yaw) -> Vector3<Scalar> {
    return k.cwiseProduct(each<Scalar>(roll, pitch, yaw));
  };
  RateGains<Scalar>& rate = gains.rate;
  rate.proportional = scaled(p.mc_rollrate_p, p.mc_pitchrate_p, p.mc_yawrate_p);
  rate.integral = scaled(p.mc_rollrate_i, p.mc_pitchrate_i, p.mc_yawrate_i);
  rate.derivative = scaled(p.mc_rollrate_d, p.mc_pitchrate_d, p.mc_yawrate_d);
  rate.feed_forward = each<Scalar>(p.mc_rollrate_ff, p.mc_pitchrate_ff, p.mc_yawrate_ff);
  rate.integral_max = each<Scalar>(p.mc_rr_int_lim, p.mc_pr_int_lim, p.mc_yr_int_lim);

  AcroGains<Scalar>& acro = gains.acro;
  acro.rate_max_rad_s = radians_each<Scalar>(p.mc_acro_r_max, p.mc_acro_p_max, p.mc_acro_y_max);
  acro.expo = each<Scalar>(p.mc_acro_expo, p.mc_acro_expo, p.mc_acro_expo_y);
  acro.superexpo = each<Scalar>(p.mc_acro_supexpo, p.mc_acro_supexpo, p.mc_acro_supexpoy);

  constexpr float turn_rad = 6.28318548f;
  const Scalar cutoff_Hz = Scalar(p.mc_yaw_tq_cutoff);
  gains.yaw_torque_tau_s =
      cutoff_Hz > Scalar(epsilon) ? Scalar(1) / (Scalar(turn_rad) * cutoff_Hz) : Scalar(0);
  gains.battery_scaling = p.mc_bat_scale_en != 0.0f;
  return gains;
}

}  // namespace attest::cascade
