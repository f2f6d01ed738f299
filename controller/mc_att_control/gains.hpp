// The gains of the loops: the parameters in SI units. The time constants of roll and pitch scale
// the proportional and the derivative gains.
//
// Body axes are FRD and vectors are in the order roll, pitch, yaw. Plain values; any thread.
#pragma once

#include "controller/mc_att_control/ordered.hpp"
#include "controller/mc_att_control/parameters.hpp"
#include "controller/mc_att_control/rotation.hpp"

namespace attest::mc_att_control {

template <typename Scalar>
struct AttitudeGains {
  Vector3<Scalar> proportional_1_s;     // rate setpoint for each radian of error
  Vector3<Scalar> rate_max_rad_s;       // limit when a pilot flies
  Vector3<Scalar> auto_rate_max_rad_s;  // limit in autonomous modes
  Scalar yaw_feed_forward;              // [1] share of the commanded yaw rate
  Scalar weathervane_scale;             // [1] share of the autonomous yaw limit
};

template <typename Scalar>
struct RateGains {
  Vector3<Scalar> proportional;
  Vector3<Scalar> integral;
  Vector3<Scalar> derivative;
  Vector3<Scalar> feed_forward;
  Scalar tpa_break;  // [0..1] thrust
  Scalar tpa_slope;
};

template <typename Scalar>
struct Gains {
  AttitudeGains<Scalar> attitude;
  RateGains<Scalar> rate;
  Vector3<Scalar> acro_rate_max_rad_s;
  Scalar rattitude_threshold;  // [0..1] stick deflection
  bool battery_scaling;        // controls are multiplied by battery_status.scale
  bool actuators_cut;          // circuit breaker: actuator controls are not published
};

// The value of CBRK_RATE_CTRL that opens the breaker (PX4 v1.5.5 circuit_breaker).
inline constexpr float rate_control_breaker_key = 140253.0f;

// The gain parameters apply to this time constant. A shorter time constant raises the gains.
inline constexpr float nominal_time_constant_s = 0.2f;

template <typename Scalar>
Gains<Scalar> compute_gains(const Parameters& p) {
  const Scalar one = 1;
  const auto radians_each = [](float roll_deg, float pitch_deg, float yaw_deg) {
    return Vector3<Scalar>(radians(Scalar(roll_deg)), radians(Scalar(pitch_deg)),
                           radians(Scalar(yaw_deg)));
  };
  const Vector3<Scalar> speed_up(Scalar(nominal_time_constant_s) / Scalar(p.mc_roll_tc),
                                 Scalar(nominal_time_constant_s) / Scalar(p.mc_pitch_tc), one);
  const auto scaled = [&speed_up](float roll, float pitch, float yaw) {
    return Vector3<Scalar>(Scalar(roll) * speed_up[0], Scalar(pitch) * speed_up[1], Scalar(yaw));
  };
  Gains<Scalar> gains;
  AttitudeGains<Scalar>& attitude = gains.attitude;
  attitude.proportional_1_s = scaled(p.mc_roll_p, p.mc_pitch_p, p.mc_yaw_p);
  attitude.rate_max_rad_s = radians_each(p.mc_rollrate_max, p.mc_pitchrate_max, p.mc_yawrate_max);
  attitude.auto_rate_max_rad_s =
      radians_each(p.mc_rollrate_max, p.mc_pitchrate_max, p.mc_yawrauto_max);
  attitude.yaw_feed_forward = Scalar(p.mc_yaw_ff);
  attitude.weathervane_scale = Scalar(p.vt_wv_yawr_scl);

  // As in PX4 v1.5.5, the time constants do not scale the integral and the feed-forward.
  RateGains<Scalar>& rate = gains.rate;
  rate.proportional = scaled(p.mc_rollrate_p, p.mc_pitchrate_p, p.mc_yawrate_p);
  rate.integral =
      Eigen::Vector3f(p.mc_rollrate_i, p.mc_pitchrate_i, p.mc_yawrate_i).template cast<Scalar>();
  rate.derivative = scaled(p.mc_rollrate_d, p.mc_pitchrate_d, p.mc_yawrate_d);
  rate.feed_forward =
      Eigen::Vector3f(p.mc_rollrate_ff, p.mc_pitchrate_ff, p.mc_yawrate_ff).template cast<Scalar>();
  rate.tpa_break = Scalar(p.mc_tpa_break);
  rate.tpa_slope = Scalar(p.mc_tpa_slope);

  gains.acro_rate_max_rad_s = radians_each(p.mc_acro_r_max, p.mc_acro_p_max, p.mc_acro_y_max);
  gains.rattitude_threshold = Scalar(p.mc_ratt_th);
  gains.battery_scaling = p.mc_bat_scale_en != 0.0f;
  gains.actuators_cut = p.cbrk_rate_ctrl == rate_control_breaker_key;
  return gains;
}

}  // namespace attest::mc_att_control
