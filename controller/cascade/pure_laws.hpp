// The two laws of v1.14 to v1.18 alone, without their units, for attest_law.h.
//
// Law is that of the unit: cascade::AttitudeUnitLaw or cascade::RateUnitLaw, or a copy with a stage
// replaced. Of its step it uses the traits and the gains, so that a mistake there shows here, too.
#pragma once

#include "controller/attest_law.h"
#include "controller/cascade/attitude_unit.hpp"
#include "controller/cascade/rate_unit.hpp"
#include "controller/mc_att_control/law_structs.hpp"

namespace attest::cascade {

template <typename Scalar, typename Law = AttitudeUnitLaw<Scalar>>
class PureAttitudeLaw {
 public:
  explicit PureAttitudeLaw(Profile profile, const Law& law = {})
      : stages_(law.step),
        follows_model_(stages_.traits(profile).follows_reference_model),
        law_(follows_model_, law.attitude, law.model) {}

  void step(const attest_attitude_law_inputs& in, attest_attitude_law_outputs& out) {
    law_.set_gains(gains(in.attitude_gains));
    take(in.vehicle_attitude_setpoint);
    const Vector3<Scalar> rates = law_.update(quaternion_from<Scalar>(in.vehicle_attitude.q));
    mc_att_control::write(rates, out);
  }

 private:
  using Given = decltype(attest_attitude_law_inputs::attitude_gains);
  using Setpoint = decltype(attest_attitude_law_inputs::vehicle_attitude_setpoint);

  AttitudeUnitGains<Scalar> gains(const Given& given) const {
    Parameters parameters{};
    mc_att_control::set_gains(given, parameters);
    parameters.mc_yaw_weight = given.yaw_weight;
    parameters.mc_ref_w_n = given.ref_w_n;
    parameters.mc_ref_ff = given.ref_ff;
    AttitudeUnitGains<Scalar> gains = stages_.gains(parameters);
    // Limits are given in radians; those of parameters are in degrees.
    gains.attitude.rate_max_rad_s = vector_from<Scalar>(given.rate_max);
    gains.model.feed_forward_max_rad_s = max(Scalar(given.ref_ff_max), Scalar(0));
    return gains;
  }

  // The model takes a setpoint once only.
  void take(const Setpoint& setpoint) {
    if (follows_model_ && setpoint.timestamp <= last_us_) return;
    law_.set_setpoint(quaternion_from<Scalar>(setpoint.q_d), Scalar(setpoint.yaw_sp_move_rate),
                      setpoint.timestamp, last_us_);
    last_us_ = setpoint.timestamp;
  }

  [[no_unique_address]] decltype(Law::step) stages_;
  bool follows_model_;
  AttitudeLaw<Scalar, decltype(Law::attitude), decltype(Law::model)> law_;
  std::uint64_t last_us_ = 0;
};

template <typename Scalar, typename Law = RateUnitLaw<Scalar>>
class PureRateLaw {
 public:
  explicit PureRateLaw(Profile /*all have this law*/, const Law& law = {})
      : stages_(law.step), rate_stages_(law.rate), law_(law.rate) {}

  void step(const attest_rate_law_inputs& in, attest_rate_law_outputs& out) {
    law_.set_gains(gains(in.rate_gains));
    law_.set_saturation(flags(in.saturation));
    if (in.law.reset != 0) law_.reset_integral();
    const auto& sp = in.vehicle_rates_setpoint;
    const Vector3<Scalar> torque = law_.update(
        {.rates_B = vector_from<Scalar>(in.vehicle_angular_velocity.xyz),
         .rates_sp_B = each<Scalar>(sp.roll, sp.pitch, sp.yaw),
         .acceleration_B = vector_from<Scalar>(in.vehicle_angular_velocity.xyz_derivative),
         .dt_s = Scalar(in.law.dt),
         .maybe_landed = false,
         .landed = in.law.landed != 0});
    mc_att_control::write(torque, law_.integral(), out);
  }

 private:
  using Given = decltype(attest_rate_law_inputs::rate_gains);
  using Flags = decltype(attest_rate_law_inputs::saturation);

  RateGains<Scalar> gains(const Given& given) const {
    Parameters parameters{};
    parameters.mc_rollrate_k = parameters.mc_pitchrate_k = parameters.mc_yawrate_k = 1.0f;
    mc_att_control::set_gains(given, parameters);
    parameters.mc_rr_int_lim = given.integral_max[0];
    parameters.mc_pr_int_lim = given.integral_max[1];
    parameters.mc_yr_int_lim = given.integral_max[2];
    return stages_.gains(parameters).rate;
  }

  // Both directions go through the stage of the unit, one after the other, because the allocator
  // reports one of them only.
  Saturation flags(const Flags& given) const {
    typename RateLaw<Scalar>::Allocation up{}, down{};
    for (std::size_t i = 0; i < 3; ++i) {
      up.unallocated_torque[i] = given.positive[i] != 0 ? 1.0f : 0.0f;
      down.unallocated_torque[i] = given.negative[i] != 0 ? -1.0f : 0.0f;
    }
    const Saturation of_up = rate_stages_.saturation(up);
    return rate_stages_.either(of_up, rate_stages_.saturation(down));
  }

  [[no_unique_address]] decltype(Law::step) stages_;
  [[no_unique_address]] decltype(Law::rate) rate_stages_;
  RateLaw<Scalar, decltype(Law::rate)> law_;
};

}  // namespace attest::cascade
