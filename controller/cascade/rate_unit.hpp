// The rate unit: one step for each vehicle_angular_velocity sample.
//
//     parameters, dt of the samples, latch the topics that were updated
//     acro: a new stick sample publishes a rates setpoint
//     other modes: latch the rates setpoint
//     if rates are controlled: rate law, low-pass of the yaw torque, battery scaling, publish
//
// Frames: world NED, body FRD. Units are those of attest_cascade.h. No clock, no allocation after
// construction. The caller owns both structs of a step; one thread at a time for one instance.
#pragma once

#include <cstdint>
#include <string_view>

#include "controller/attest_cascade.h"
#include "controller/cascade/gains.hpp"
#include "controller/cascade/parameters.hpp"
#include "controller/cascade/profile.hpp"
#include "controller/cascade/rate_law.hpp"

namespace attest::cascade {

// Copies of the topics that are latched in the step in which they arrive.
struct RateTopics {
  decltype(attest_rate_inputs::vehicle_control_mode) mode{};
  decltype(attest_rate_inputs::vehicle_land_detected) land{.maybe_landed = 1, .landed = 1};
  bool is_rotary_wing = true;
};

// The topic vehicle_rates_setpoint.
template <typename Scalar>
struct RatesSetpoint {
  Vector3<Scalar> rates_B = Vector3<Scalar>::Zero();  // [rad/s]
  Vector3<Scalar> thrust_B = Vector3<Scalar>::Zero();
};

// The stages of a step outside the rate law. Pure functions of their arguments, except
// filtered_yaw(), which changes the filter.
template <typename Scalar>
struct RateStepStages {
  using Vector = Vector3<Scalar>;
  using Sticks = decltype(attest_rate_inputs::manual_control_setpoint);

  // This function is a stage, so that a fault can replace it and take a trait of another profile.
  static ProfileTraits traits(Profile profile) { return traits_of(profile); }

  static RateUnitGains<Scalar> gains(const Parameters& parameters) {
    return rate_unit_gains<Scalar>(parameters);
  }

  // dt [s], limited to 0.125 .. 20 ms. The difference is rounded to Scalar before it is scaled.
  ATTEST_INLINE static Scalar step_time(std::uint64_t sample_us, std::uint64_t last_us) {
    return clamp(Scalar(sample_us - last_us) * Scalar(1e-6f), Scalar(0.000125f), Scalar(0.02f));
  }

  ATTEST_INLINE static bool is_acro(const RateTopics& topics) {
    return topics.mode.flag_control_manual_enabled != 0 &&
           topics.mode.flag_control_attitude_enabled == 0;
  }

  // The sticks set the rates, and the throttle sets the thrust, which is not clamped.
  static RatesSetpoint<Scalar> acro(const Sticks& sticks, const AcroGains<Scalar>& gains) {
    const Vector stick(Scalar(sticks.roll), -Scalar(sticks.pitch), Scalar(sticks.yaw));
    Vector curve;
    for (int i = 0; i < 3; ++i) curve[i] = superexpo(stick[i], gains.expo[i], gains.superexpo[i]);
    const Scalar thrust = -(Scalar(sticks.throttle) + Scalar(1)) * Scalar(0.5f);
    return {curve.cwiseProduct(gains.rate_max_rad_s), {Scalar(0), Scalar(0), thrust}};
  }

  // The bits of the pending topics. A sample stays pending until the law uses it.
  ATTEST_INLINE static std::uint32_t pending(std::uint32_t before, std::uint32_t updated) {
    return before | updated;
  }

  // Whether the unit's own rates setpoint replaces a pending external one.
  ATTEST_INLINE static bool supersedes_pending() { return true; }

  // If a component of the setpoint is not finite when it is latched, the rate that is measured in
  // this step replaces it.
  ATTEST_INLINE static Scalar commanded(Scalar rate_sp, Scalar rate) {
    return is_finite(rate_sp) ? rate_sp : rate;
  }

  // While this is true, every step that controls the rates first resets the integral to 0.
  ATTEST_INLINE static bool resets_integral(const RateTopics& topics) {
    return topics.mode.flag_armed == 0 || !topics.is_rotary_wing;
  }

  // A NaN stays in the filter permanently. With a time constant of 0 the filter computes
  // state + (torque - state), which may differ from the torque by rounding.
  ATTEST_INLINE static Scalar filtered_yaw(LowPass<Scalar>& filter, Scalar torque, Scalar dt_s,
                                           const RateUnitGains<Scalar>& gains,
                                           const ProfileTraits& law) {
    return filter.update(gains.yaw_torque_tau_s, dt_s, torque, law);
  }

  // A torque that is not finite becomes 0. Thrust is not guarded.
  ATTEST_INLINE static Scalar guarded(Scalar torque) {
    return is_finite(torque) ? torque : Scalar(0);
  }

  // The scale after a battery sample. The old scale stays if no battery is connected or the scale
  // is not positive.
  ATTEST_INLINE static Scalar battery_scale(
      Scalar before, const decltype(attest_rate_inputs::battery_status)& sample) {
    return sample.connected != 0 && sample.scale > 0.0f ? Scalar(sample.scale) : before;
  }

  // Torque and thrust are clamped here only, so without battery scaling they are not clamped.
  ATTEST_INLINE static Scalar scaled(Scalar control, Scalar battery_scale) {
    return clamp(control * battery_scale, Scalar(-1), Scalar(1));
  }
};

// A law: the stages of the whole unit. This is the unmodified law.
template <typename Scalar>
struct RateUnitLaw {
  [[no_unique_address]] RateStepStages<Scalar> step;
  [[no_unique_address]] RateStages<Scalar> rate;
};

template <typename Scalar, typename Law = RateUnitLaw<Scalar>>
class RateUnit {
 public:
  explicit RateUnit(Profile profile, const Law& law = {});

  // Same as AttitudeUnit::set_parameter(), but with ATTEST_RATE_UPDATED_PARAMETER_UPDATE.
  bool set_parameter(std::string_view name, float value);

  // One step. Writes `published` of every topic, and the other fields only of published topics.
  void step(const attest_rate_inputs& in, attest_rate_outputs& out);

 private:
  void read_parameters();
  void latch_topics(const attest_rate_inputs& in);
  bool take_pending(std::uint32_t topic);
  void follow_sticks(const attest_rate_inputs& in, attest_rate_outputs& out);
  void follow_setpoint(const attest_rate_inputs& in);
  void control_rates(const attest_rate_inputs& in, Scalar dt_s, attest_rate_outputs& out);
  void scale_by_battery(const attest_rate_inputs& in, Vector3<Scalar>& torque,
                        Vector3<Scalar>& thrust);
  void publish_status(attest_rate_outputs& out) const;

  Profile profile_;
  ProfileTraits traits_;
  Parameters parameters_;
  RateUnitGains<Scalar> gains_{};
  [[no_unique_address]] decltype(Law::step) stages_;
  RateLaw<Scalar, decltype(Law::rate)> rate_;
  LowPass<Scalar> yaw_torque_;
  RateTopics topics_;
  RatesSetpoint<Scalar> newest_setpoint_;  // own or external
  RatesSetpoint<Scalar> setpoint_;         // the one in use
  Scalar battery_scale_ = Scalar(0);       // 0 before the first valid sample
  std::uint64_t last_sample_us_ = 0;
  std::uint32_t pending_ = 0;  // ATTEST_RATE_UPDATED_... bits of topics not yet latched
  bool first_step_ = true;
};

extern template class RateUnit<float>;
extern template class RateUnit<double>;

}  // namespace attest::cascade
