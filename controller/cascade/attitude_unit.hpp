// The attitude unit: one step for each vehicle_attitude sample.
//
//     parameters, hover thrust estimate, dt of the samples
//     v1.14.4: attitude setpoint, reset of the estimator
//     latch the topics that were updated
//     stabilized mode: the sticks publish an attitude setpoint
//     if the attitude is controlled:
//         from v1.15.4: attitude setpoint, reset of the estimator
//         attitude law, autotune
//     thrust limits and hover thrust for the next step
//
// Frames: world NED, body FRD. Units are those of attest_cascade.h. No clock, no allocation after
// construction. The caller owns both structs of a step; one thread at a time for one instance.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string_view>

#include "controller/attest_cascade.h"
#include "controller/cascade/attitude_law.hpp"
#include "controller/cascade/gains.hpp"
#include "controller/cascade/parameters.hpp"
#include "controller/cascade/profile.hpp"
#include "controller/cascade/sticks.hpp"

namespace attest::cascade {

// Copies of the topics that every step latches, and the newest autotune sample.
struct AttitudeTopics {
  decltype(attest_attitude_inputs::manual_control_setpoint) manual{};
  decltype(attest_attitude_inputs::vehicle_control_mode) mode{};
  decltype(attest_attitude_inputs::vehicle_status) status{.armed_time = 0,
                                                          .armed = 0,
                                                          .is_rotary_wing = 1,
                                                          .is_vtol = 0,
                                                          .in_transition_mode = 0,
                                                          .is_vtol_tailsitter = 0};
  decltype(attest_attitude_inputs::vehicle_local_position) position{
      .unaided_heading = std::numeric_limits<float>::quiet_NaN(), .heading_good_for_control = 1};
  decltype(attest_attitude_inputs::autotune_attitude_control_status) autotune{};  // idle
  bool landed = true;
  bool spooled = false;  // computed only when vehicle_status is latched
};

// The stages of a step outside the attitude law and the sticks. Pure functions of their arguments.
template <typename Scalar>
struct AttitudeStepStages {
  using Topics = AttitudeTopics;
  using Status = decltype(Topics::status);

  // This function is a stage, so that a fault can replace it and take a trait of another profile.
  static ProfileTraits traits(Profile profile) { return traits_of(profile); }

  static AttitudeUnitGains<Scalar> gains(const Parameters& parameters) {
    return attitude_unit_gains<Scalar>(parameters);
  }

  // dt [s], limited to 0.2 .. 20 ms. The difference is rounded to Scalar before it is scaled.
  ATTEST_INLINE static Scalar step_time(std::uint64_t sample_us, std::uint64_t last_us) {
    return clamp(Scalar(sample_us - last_us) * Scalar(1e-6f), Scalar(0.0002f), Scalar(0.02f));
  }

  ATTEST_INLINE static Scalar hover_estimate(
      const decltype(attest_attitude_inputs::hover_thrust_estimate)& sample,
      const StickGains<Scalar>& gains) {
    return sample.valid != 0 ? clamp(Scalar(sample.hover_thrust), Scalar(0.05f), Scalar(0.9f))
                             : gains.thrust_hover;
  }

  // Whether the motors have had time to reach their speed since arming.
  ATTEST_INLINE static bool is_spooled(std::uint64_t now_us, const Status& status,
                                       Scalar spoolup_us) {
    return status.armed != 0 && Scalar(now_us - status.armed_time) > spoolup_us;
  }

  // A tailsitter flies as a multicopter during a transition, too.
  ATTEST_INLINE static bool runs(const Topics& topics) {
    const Status& status = topics.status;
    const bool transition = status.in_transition_mode != 0;
    const bool hovers = status.is_rotary_wing != 0 && !transition;
    const bool tailsitter = status.is_vtol_tailsitter != 0 && transition;
    return topics.mode.flag_control_attitude_enabled != 0 && (hovers || tailsitter);
  }

  // Whether the mode is stabilized.
  ATTEST_INLINE static bool follows_sticks(const Topics& topics) {
    const auto& mode = topics.mode;
    return mode.flag_control_manual_enabled != 0 && mode.flag_control_altitude_enabled == 0 &&
           mode.flag_control_velocity_enabled == 0 && mode.flag_control_position_enabled == 0;
  }

  // A sample stays pending until the law uses it.
  ATTEST_INLINE static bool is_pending(bool before, bool updated) { return before || updated; }

  // Whether the unit's own attitude setpoint replaces a pending external one.
  ATTEST_INLINE static bool supersedes_pending() { return true; }

  ATTEST_INLINE static bool is_newer(std::uint64_t setpoint_us, std::uint64_t last_setpoint_us) {
    return setpoint_us > last_setpoint_us;
  }

  // A setpoint from before the estimator's reset must be turned with the estimate.
  ATTEST_INLINE static bool precedes_reset(std::uint64_t last_setpoint_us,
                                           std::uint64_t attitude_us) {
    return attitude_us > last_setpoint_us;
  }

  // Autotune excites the vehicle in these states. Its rates are added after the rate limit.
  ATTEST_INLINE static Vector3<Scalar> autotuned(const Vector3<Scalar>& rates, const Topics& topics,
                                                 std::uint64_t now_us, const ProfileTraits& law) {
    const auto& autotune = topics.autotune;
    const bool excites =
        std::ranges::find(law.autotune_states, autotune.state) != law.autotune_states.end();
    const bool recent = now_us - autotune.timestamp < 1000000;
    if (!excites || !recent) return rates;
    return rates + vector_from<Scalar>(autotune.rate_sp);
  }

  ATTEST_INLINE static Scalar thrust_min(Scalar before, Scalar dt_s, bool landed,
                                         const StickGains<Scalar>& gains) {
    return slewed(before, Scalar(0.05f), dt_s, landed ? Scalar(0) : gains.thrust_min);
  }

  ATTEST_INLINE static Scalar thrust_max(Scalar before, Scalar dt_s, bool spooled) {
    return spooled ? slewed(before, Scalar(0.5f), dt_s, Scalar(1)) : Scalar(0);
  }

  ATTEST_INLINE static Scalar hover_thrust(Scalar before, Scalar dt_s, Scalar estimate) {
    return is_finite(estimate) ? slewed(before, Scalar(0.05f), dt_s, estimate) : before;
  }

  // Up to v1.15.4: whether the next step in stabilized mode takes the heading as its yaw setpoint.
  ATTEST_INLINE static bool restarts_yaw(bool followed_sticks, const Topics& topics) {
    return !followed_sticks || topics.position.heading_good_for_control == 0 ||
           (topics.status.is_vtol != 0 && topics.status.in_transition_mode != 0);
  }
};

// A law: the stages of the whole unit. This is the unmodified law.
template <typename Scalar>
struct AttitudeUnitLaw {
  [[no_unique_address]] AttitudeStepStages<Scalar> step;
  [[no_unique_address]] StickStages<Scalar> sticks;
  [[no_unique_address]] AttitudeStages<Scalar> attitude;
  [[no_unique_address]] ReferenceModelStages<Scalar> model;
};

template <typename Scalar, typename Law = AttitudeUnitLaw<Scalar>>
class AttitudeUnit {
 public:
  explicit AttitudeUnit(Profile profile, const Law& law = {});

  // Sets one parameter by its PX4 name. A value set before the first step holds from creation on. A
  // later value takes effect in the next step that has ATTEST_ATTITUDE_UPDATED_PARAMETER_UPDATE
  // set. Returns false in the same cases as set_parameter() in parameters.hpp.
  bool set_parameter(std::string_view name, float value);

  // One step. Writes `published` of every topic, and the other fields only of published topics.
  void step(const attest_attitude_inputs& in, attest_attitude_outputs& out);

 private:
  void read_parameters();
  void latch_newest(const attest_attitude_inputs& in);
  void latch_topics(const attest_attitude_inputs& in);
  void follow_sticks(const attest_attitude_inputs& in, attest_attitude_outputs& out);
  static void publish_attitude_setpoint(const AttitudeSetpoint<Scalar>& setpoint,
                                        attest_attitude_outputs& out);
  void take_attitude_setpoint();
  void set_attitude_setpoint(const AttitudeSetpoint<Scalar>& setpoint);
  void follow_estimator_reset(const attest_attitude_inputs& in);
  void publish_rates(const attest_attitude_inputs& in, attest_attitude_outputs& out);
  void move_thrust_limits();

  Profile profile_;
  ProfileTraits traits_;
  Parameters parameters_;
  AttitudeUnitGains<Scalar> gains_{};
  [[no_unique_address]] decltype(Law::step) stages_;
  Sticks<Scalar, decltype(Law::sticks)> sticks_;
  AttitudeLaw<Scalar, decltype(Law::attitude), decltype(Law::model)> attitude_;
  AttitudeTopics topics_;
  AttitudeSetpoint<Scalar> newest_setpoint_;  // own or external
  bool setpoint_pending_ = false;             // newest_setpoint_ has not been latched yet
  std::uint64_t last_setpoint_us_ = 0;
  Vector3<Scalar> thrust_B_ = Vector3<Scalar>::Zero();
  ThrustLimits<Scalar> thrust_limits_;
  Scalar hover_estimate_ = Scalar(std::numeric_limits<float>::quiet_NaN());
  Scalar dt_s_ = Scalar(0);
  std::uint64_t last_sample_us_ = 0;
  std::uint8_t reset_counter_ = 0;
  bool first_step_ = true;
};

extern template class AttitudeUnit<float>;
extern template class AttitudeUnit<double>;

}  // namespace attest::cascade
