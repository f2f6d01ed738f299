// The stages of a step outside the two loops: time, modes, sticks and actuators.
//
// Angular rates [rad/s], time [s], sticks and thrust as in attest_unit.h. Pure; any thread.
#pragma once

#include <cmath>
#include <cstdint>

#include "controller/attest_unit.h"
#include "controller/mc_att_control/gains.hpp"
#include "controller/mc_att_control/inline.hpp"
#include "controller/mc_att_control/profile.hpp"
#include "controller/mc_att_control/rate_control.hpp"

namespace attest::mc_att_control {

// The latched copies of the topics. All zero at first, except that the vehicle starts as a rotary
// wing. The controller's own rates setpoint overwrites an external one in `rates_setpoint`.
struct Topics {
  decltype(attest_inputs::vehicle_attitude_setpoint) attitude_setpoint{};
  decltype(attest_inputs::vehicle_rates_setpoint) rates_setpoint{};
  decltype(attest_inputs::manual_control_setpoint) manual{};
  decltype(attest_inputs::vehicle_control_mode) mode{};
  MotorLimits limits{};
  float battery_scale = 0.0f;
  bool armed = false;
  bool is_rotary_wing = true;
};

// The command of the outer loop to the rate loop in one step.
template <typename Scalar>
struct RateCommand {
  Vector3<Scalar> rates_sp_B;  // [rad/s]
  Scalar thrust_sp;            // [0..1]
};

template <typename Scalar>
struct StepStages {
  using Vector = Vector3<Scalar>;

  // The difference of the timestamps, clamped to 2 .. 20 ms.
  ATTEST_INLINE static Scalar step_time(std::uint64_t now_us, std::uint64_t last_us) {
    constexpr float shortest_s = 0.002f, longest_s = 0.02f;
    const Scalar dt_s = Scalar(now_us - last_us) / Scalar(1000000);
    return clamp(dt_s, Scalar(shortest_s), Scalar(longest_s));
  }

  static Gains<Scalar> gains(const Parameters& parameters) {
    return compute_gains<Scalar>(parameters);
  }

  // Rattitude: beyond the threshold the sticks command rates instead of attitude.
  ATTEST_INLINE static bool sticks_beyond(const decltype(Topics::manual)& manual,
                                          Scalar threshold) {
    using std::abs;
    return abs(Scalar(manual.y)) > threshold || abs(Scalar(manual.x)) > threshold;
  }

  ATTEST_INLINE static bool is_autonomous(const decltype(Topics::mode)& mode, Profile profile) {
    const bool by_vehicle =
        mode.flag_control_velocity_enabled != 0 ||
        (traits_of(profile).limits_rates_in_auto && mode.flag_control_auto_enabled != 0);
    return by_vehicle && mode.flag_control_manual_enabled == 0;
  }

  // While weather-vaning, the wind may turn the nose.
  ATTEST_INLINE static bool is_weathervaning(bool autonomous,
                                             const decltype(Topics::attitude_setpoint)& setpoint) {
    return autonomous && setpoint.disable_mc_yaw_control != 0;
  }

  // Whether the controller's own rates setpoint replaces a pending external one. It does if both
  // are on the same topic. A VTOL publishes its own on mc_virtual_rates_setpoint.
  ATTEST_INLINE static bool supersedes_pending(bool is_vtol) { return !is_vtol; }

  // Acro limits thrust to 0.9, which leaves the mixer headroom for attitude control.
  ATTEST_INLINE static RateCommand<Scalar> acro(const decltype(Topics::manual)& manual,
                                                const Gains<Scalar>& gains) {
    constexpr float thrust_max = 0.9f;
    const Vector sticks(Scalar(manual.y), Scalar(-manual.x), Scalar(manual.r));
    // Written so that a NaN throttle gives the maximum.
    const float thrust_sp = manual.z < thrust_max ? manual.z : thrust_max;
    return {sticks.cwiseProduct(gains.acro_rate_max_rad_s), Scalar(thrust_sp)};
  }

  ATTEST_INLINE static bool is_flying(const Topics& topics) {
    return topics.armed && topics.is_rotary_wing;
  }

  ATTEST_INLINE static float guarded(float value) { return std::isfinite(value) ? value : 0.0f; }

  // The factor on the first four controls.
  ATTEST_INLINE static float battery_factor(const Topics& topics, const Gains<Scalar>& gains,
                                            Profile profile) {
    const bool scales = traits_of(profile).scales_by_battery && gains.battery_scaling &&
                        topics.battery_scale > 0.0f;
    return scales ? topics.battery_scale : 1.0f;
  }
};

}  // namespace attest::mc_att_control
