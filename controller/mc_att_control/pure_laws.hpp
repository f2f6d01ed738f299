// The two laws of v1.5.5 and v1.3.4 alone, without the controller around them, for attest_law.h.
//
// Law is McAttControlLaw, or a copy with a stage replaced. Of its step it uses the gains, so that a
// mistake there shows here, too.
#pragma once

#include "controller/attest_law.h"
#include "controller/mc_att_control/law_structs.hpp"
#include "controller/mc_att_control/mc_att_control.hpp"

namespace attest::mc_att_control {

template <typename Scalar>
Vector3<Scalar> vector_from(const float (&xyz)[3]) {
  return {Scalar(xyz[0]), Scalar(xyz[1]), Scalar(xyz[2])};
}

// All parameters 0, and time constants that do not scale the gains.
inline Parameters unscaled_parameters() {
  Parameters parameters{};
  parameters.mc_roll_tc = parameters.mc_pitch_tc = nominal_time_constant_s;
  return parameters;
}

template <typename Scalar, typename Law = McAttControlLaw<Scalar>>
class PureAttitudeLaw {
 public:
  explicit PureAttitudeLaw(Profile profile, const Law& law = {})
      : stages_(law.step), law_(profile, law.attitude) {}

  void step(const attest_attitude_law_inputs& in, attest_attitude_law_outputs& out) {
    law_.set_gains(gains(in.attitude_gains));
    const bool weathervane = in.law.weathervane != 0;
    const Vector3<Scalar> rates = law_.update(
        {.q_WB = quaternion_from<Scalar>(in.vehicle_attitude.q),
         .q_WD = quaternion_from<Scalar>(in.vehicle_attitude_setpoint.q_d),
         .yaw_sp_move_rate_rad_s = Scalar(in.vehicle_attitude_setpoint.yaw_sp_move_rate),
         .autonomous = weathervane,
         .weathervane = weathervane});
    write(rates, out);
  }

 private:
  using Given = decltype(attest_attitude_law_inputs::attitude_gains);

  AttitudeGains<Scalar> gains(const Given& given) const {
    Parameters parameters = unscaled_parameters();
    set_gains(given, parameters);
    parameters.mc_yaw_ff = given.yaw_ff;
    parameters.vt_wv_yawr_scl = given.weathervane_scale;
    AttitudeGains<Scalar> gains = stages_.gains(parameters).attitude;
    // The limits are given in radians, and are those of the mode that the vehicle is in.
    gains.rate_max_rad_s = gains.auto_rate_max_rad_s = vector_from<Scalar>(given.rate_max);
    return gains;
  }

  [[no_unique_address]] decltype(Law::step) stages_;
  AttitudeControl<Scalar, decltype(Law::attitude)> law_;
};

template <typename Scalar, typename Law = McAttControlLaw<Scalar>>
class PureRateLaw {
 public:
  explicit PureRateLaw(Profile profile, const Law& law = {})
      : stages_(law.step), law_(profile, law.rate) {}

  void step(const attest_rate_law_inputs& in, attest_rate_law_outputs& out) {
    law_.set_gains(gains(in.rate_gains));
    law_.set_previous(vector_from<Scalar>(in.previous.rates),
                      vector_from<Scalar>(in.previous.rates_sp));
    const auto& sp = in.vehicle_rates_setpoint;
    const auto& limits = in.multirotor_motor_limits;
    const Vector3<Scalar> torque =
        law_.update({.rates_B = vector_from<Scalar>(in.vehicle_angular_velocity.xyz),
                     .rates_sp_B = {Scalar(sp.roll), Scalar(sp.pitch), Scalar(sp.yaw)},
                     .thrust_sp = Scalar(sp.thrust),
                     .published_thrust_sp = Scalar(sp.thrust),
                     .dt_s = Scalar(in.law.dt),
                     .limits = {limits.lower_limit != 0, limits.upper_limit != 0, limits.yaw != 0},
                     .flying = in.law.reset == 0});
    write(torque, law_.integral(), out);
  }

 private:
  using Given = decltype(attest_rate_law_inputs::rate_gains);

  RateGains<Scalar> gains(const Given& given) const {
    Parameters parameters = unscaled_parameters();
    set_gains(given, parameters);
    parameters.mc_tpa_break = given.tpa_break;
    parameters.mc_tpa_slope = given.tpa_slope;
    return stages_.gains(parameters).rate;
  }

  [[no_unique_address]] decltype(Law::step) stages_;
  RateControl<Scalar, decltype(Law::rate)> law_;
};

}  // namespace attest::mc_att_control
