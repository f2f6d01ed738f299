// The multicopter attitude controller: what happens once for each control_state sample.
//
// The task of PX4 v1.5.5 (or v1.3.4) mc_att_control without its bus and clock:
//
//     dt from the timestamps, clamped to 2 .. 20 ms
//     latch the topics that were updated, apply parameters
//     rattitude: a large stick deflection clears the attitude flag
//     outer loop: attitude (or tailsitter recovery), acro, or rates from outside
//     if rates are controlled: rate loop, actuators, status
//
// Frames: world NED, body FRD. Units are those of attest_unit.h. No clock, no allocation after
// construction. The caller owns both structs of a step; one thread at a time for one instance.
#pragma once

#include <cstdint>
#include <string_view>

#include "controller/attest_unit.h"
#include "controller/reference/attitude_control.hpp"
#include "controller/reference/gains.hpp"
#include "controller/reference/parameters.hpp"
#include "controller/reference/profile.hpp"
#include "controller/reference/rate_control.hpp"
#include "controller/reference/tailsitter_recovery.hpp"

namespace attest::reference {

// The latched copies of the topics. All zero at first, except that the vehicle starts as a rotary
// wing. `rates_setpoint` is one variable: what the controller publishes overwrites it too.
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

// What the outer loop asks of the rate loop in one step.
template <typename Scalar>
struct RateCommand {
  Vector3<Scalar> rates_sp_B;  // [rad/s]
  Scalar thrust_sp;            // [0..1]
};

template <typename Scalar>
class McAttControl {
 public:
  explicit McAttControl(Profile profile);

  // Sets one parameter by its PX4 name; it takes effect in the first step, then in the next one
  // that has ATTEST_UPDATED_PARAMETER_UPDATE set. False: see set_parameter() in parameters.hpp.
  bool set_parameter(std::string_view name, float value);

  // One step. Writes the fields of a topic only when it publishes the topic.
  void step(const attest_inputs& in, attest_outputs& out);

 private:
  Scalar advance_clock(std::uint64_t timestamp_us);
  void latch_topics(const attest_inputs& in);
  bool take_pending(std::uint32_t topic);
  void apply_parameters();
  void apply_rattitude();
  RateCommand<Scalar> outer_loop(const attest_inputs& in, attest_outputs& out);
  RateCommand<Scalar> control_attitude(const attest_inputs& in);
  RateCommand<Scalar> control_acro() const;
  RateCommand<Scalar> follow_rates_setpoint(const attest_inputs& in);
  void publish_rates_setpoint(const RateCommand<Scalar>& command, attest_outputs& out);
  void inner_loop(const attest_inputs& in, const RateCommand<Scalar>& command, Scalar dt_s,
                  attest_outputs& out);
  void publish_actuators(const Vector3<Scalar>& control, Scalar thrust_sp,
                         attest_outputs& out) const;
  void publish_status(attest_outputs& out) const;

  Profile profile_;
  Parameters parameters_;
  Gains<Scalar> gains_;
  AttitudeControl<Scalar> attitude_;
  RateControl<Scalar> rate_;
  TailsitterRecovery<Scalar> recovery_;
  Topics topics_;
  std::uint64_t last_timestamp_us_ = 0;
  std::uint32_t pending_ = 0;  // ATTEST_UPDATED_... bits of topics not yet latched
  bool first_step_ = true;
  bool recovery_enabled_ = false;  // decided at the first step
  bool status_seen_ = false;       // vehicle_status selects the topics to publish on
};

extern template class McAttControl<float>;
extern template class McAttControl<double>;

}  // namespace attest::reference
