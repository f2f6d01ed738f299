// The multicopter attitude controller: one step for each control_state sample.
//
// The task of PX4 v1.5.5 (or v1.3.4) mc_att_control without its bus and clock:
//
//     dt from the timestamps, clamped to 2 .. 20 ms
//     latch the topics that were updated, apply parameters
//     rattitude: a large stick deflection clears the attitude flag
//     outer loop: attitude (or tailsitter recovery), acro, or an external rates setpoint
//     if rates are controlled: rate loop, actuators, status
//
// Frames: world NED, body FRD. Units are those of attest_unit.h. No clock, no allocation after
// construction. The caller owns both structs of a step; one thread at a time for one instance.
#pragma once

#include <cstdint>
#include <string_view>

#include "controller/attest_unit.h"
#include "controller/mc_att_control/attitude_control.hpp"
#include "controller/mc_att_control/gains.hpp"
#include "controller/mc_att_control/parameters.hpp"
#include "controller/mc_att_control/profile.hpp"
#include "controller/mc_att_control/rate_control.hpp"
#include "controller/mc_att_control/step_stages.hpp"
#include "controller/mc_att_control/tailsitter_recovery.hpp"

namespace attest::mc_att_control {

// A law: the stages of every loop. This is the unmodified law; controller/faults has variants.
template <typename Scalar>
struct McAttControlLaw {
  [[no_unique_address]] StepStages<Scalar> step;
  [[no_unique_address]] AttitudeStages<Scalar> attitude;
  [[no_unique_address]] RateStages<Scalar> rate;
  [[no_unique_address]] RecoveryStages<Scalar> recovery;
};

template <typename Scalar, typename Law = McAttControlLaw<Scalar>>
class McAttControl {
 public:
  explicit McAttControl(Profile profile, const Law& law = {});

  // Sets one parameter by its PX4 name. A value set before the first step takes effect in the first
  // step. A later value takes effect in the next step that has ATTEST_UPDATED_PARAMETER_UPDATE set.
  // Returns false in the same cases as set_parameter() in parameters.hpp.
  bool set_parameter(std::string_view name, float value);

  // One step. Writes `published` of every topic, and the other fields only of published topics.
  void step(const attest_inputs& in, attest_outputs& out);

 private:
  void latch_topics(const attest_inputs& in);
  bool take_pending(std::uint32_t topic);
  void apply_parameters();
  void apply_rattitude();
  RateCommand<Scalar> outer_loop(const attest_inputs& in, attest_outputs& out);
  RateCommand<Scalar> control_attitude(const attest_inputs& in);
  RateCommand<Scalar> follow_rates_setpoint(const attest_inputs& in);
  void publish_rates_setpoint(const RateCommand<Scalar>& command, attest_outputs& out);
  void inner_loop(const attest_inputs& in, const RateCommand<Scalar>& command, Scalar dt_s,
                  attest_outputs& out);
  void publish_actuators(const Vector3<Scalar>& control, Scalar thrust_sp,
                         attest_outputs& out) const;
  void publish_status(attest_outputs& out) const;

  Profile profile_;
  Parameters parameters_;
  Gains<Scalar> gains_{};
  [[no_unique_address]] decltype(Law::step) stages_;
  AttitudeControl<Scalar, decltype(Law::attitude)> attitude_;
  RateControl<Scalar, decltype(Law::rate)> rate_;
  TailsitterRecovery<Scalar, decltype(Law::recovery)> recovery_;
  Topics topics_;
  std::uint64_t last_timestamp_us_ = 0;
  std::uint32_t pending_ = 0;  // ATTEST_UPDATED_... bits of topics not yet latched
  bool first_step_ = true;
  bool recovery_enabled_ = false;  // decided at the first step
  bool status_seen_ = false;       // the first vehicle_status has arrived
  bool is_vtol_ = false;           // is_vtol of the first vehicle_status: selects virtual topics
};

extern template class McAttControl<float>;
extern template class McAttControl<double>;

}  // namespace attest::mc_att_control
