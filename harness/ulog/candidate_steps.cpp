#include "harness/ulog/candidate_steps.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <utility>

#include "harness/ulog/own_topics.hpp"

namespace attest::ulog {
namespace {

Thrust thrust_of(const float (&values)[3]) { return {values[0], values[1], values[2]}; }

// As if another module had published it just before the step.
void give_own_setpoint(Candidate& step) {
  auto& in = step.sample.attitude_in;
  const auto& own = step.sample.attitude_out.vehicle_attitude_setpoint;
  auto& given = in.vehicle_attitude_setpoint;
  std::copy(std::begin(own.q_d), std::end(own.q_d), given.q_d);
  std::copy(std::begin(own.thrust_body), std::end(own.thrust_body), given.thrust_body);
  given.yaw_sp_move_rate = own.yaw_sp_move_rate;
  given.timestamp = in.timestamp;
  in.vehicle_control_mode.flag_control_manual_enabled = 0;
  step.has_own_setpoint = true;
  step.setpoint_us = in.timestamp;
}

}  // namespace

bool same_bits(const Thrust& a, const Thrust& b) {
  return std::memcmp(a.data(), b.data(), sizeof a) == 0;
}

const char* text_of(Unfit why) {
  switch (why) {
    case Unfit::nothing_known:
      return "before the first mode or setpoint of the log";
    case Unfit::no_own_setpoint:
      return "with sticks, and without the setpoint of the step";
    case Unfit::reset:
      return "at a reset of the estimator";
    case Unfit::other_wings:
      return "in fixed-wing flight";
  }
  return "";
}

std::optional<Candidate> Candidates::next(const Sample& tick, const LoggedSetpoint& setpoint) {
  updated_ |= tick.in.updated;
  follow_parameters();
  Candidate step{tick};
  step.sample.in.updated = updated_;  // so that a step that is left out loses no sample
  const auto unfit = log_.module == Module::rate_unit ? of_rate_unit(setpoint, step)
                                                      : of_attitude_unit(setpoint, step);
  if (!is_output_) return std::nullopt;
  ++outputs_;
  if (unfit) ++unfit_[*unfit];
  return unfit ? std::nullopt : std::optional(step);
}

std::optional<Unfit> Candidates::of_attitude_unit(const LoggedSetpoint& setpoint, Candidate& step) {
  auto& in = step.sample.attitude_in;
  const auto& out = step.sample.attitude_out;
  // The unit turns its setpoint at a reset, but only if it is older. Each step has a new one.
  const auto counter = std::exchange(in.vehicle_attitude.quat_reset_counter, std::uint8_t{0});
  const bool is_reset = std::exchange(last_counter_, counter).value_or(counter) != counter;
  is_output_ = out.vehicle_rates_setpoint.published != 0;
  if (!is_output_) return std::nullopt;
  if (setpoint.known == Known::nothing) return Unfit::nothing_known;
  if (is_reset) return Unfit::reset;
  step.used = thrust_of(out.vehicle_rates_setpoint.thrust_body);
  step.setpoint_us = setpoint.time_us;
  if (is_of_sticks(step.sample)) {
    if (out.vehicle_attitude_setpoint.published == 0) return Unfit::no_own_setpoint;
    give_own_setpoint(step);
  }
  in.updated |= ATTEST_ATTITUDE_UPDATED_VEHICLE_ATTITUDE_SETPOINT;
  step.given = thrust_of(in.vehicle_attitude_setpoint.thrust_body);
  step.age_us = in.timestamp - step.setpoint_us;
  return std::nullopt;
}

std::optional<Unfit> Candidates::of_rate_unit(const LoggedSetpoint& setpoint, Candidate& step) {
  auto& in = step.sample.rate_in;
  const auto& out = step.sample.rate_out;
  if (out.vehicle_rates_setpoint.published != 0) acro_us_ = in.timestamp;
  is_output_ = out.vehicle_torque_setpoint.published != 0 &&
               out.vehicle_thrust_setpoint.published != 0 && out.rate_ctrl_status.published != 0;
  if (!is_output_) return std::nullopt;
  if (!flies_by_rotors(Module::rate_unit, step.sample)) return Unfit::other_wings;
  step.setpoint_us = setpoint.time_us;
  if (is_acro(step.sample)) {
    give_acro_setpoint(step);
  } else if (setpoint.known == Known::nothing) {
    return Unfit::nothing_known;
  }
  if (step.setpoint_us == 0) return Unfit::nothing_known;
  in.vehicle_control_mode.flag_armed = 0;
  in.updated |= ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT;
  step.given = scaled(thrust_of(in.vehicle_rates_setpoint.thrust_body), in);
  step.used = thrust_of(out.vehicle_thrust_setpoint.xyz);
  step.age_us = in.timestamp - step.setpoint_us;
  return std::nullopt;
}

// The last one that the unit published, which it holds until a new sample of the sticks.
void Candidates::give_acro_setpoint(Candidate& step) const {
  auto& in = step.sample.rate_in;
  const auto& own = step.sample.rate_out.vehicle_rates_setpoint;
  auto& given = in.vehicle_rates_setpoint;
  given.roll = own.roll;
  given.pitch = own.pitch;
  given.yaw = own.yaw;
  std::copy(std::begin(own.thrust_body), std::end(own.thrust_body), given.thrust_body);
  in.vehicle_control_mode.flag_control_manual_enabled = 0;
  step.setpoint_us = acro_us_;
}

// Scales as the rate unit does, which holds the last scale that is valid. The inputs get this
// scale; it is not connected if nothing is scaled.
Thrust Candidates::scaled(Thrust thrust, attest_rate_inputs& in) {
  auto& battery = in.battery_status;
  if (battery.connected != 0 && battery.scale > 0) scale_ = battery.scale;
  battery.connected = scales_ && scale_ > 0 ? 1 : 0;
  battery.scale = scale_;
  if (battery.connected == 0) return thrust;
  for (float& part : thrust) part = std::clamp(part * scale_, -1.0F, 1.0F);
  return thrust;
}

void Candidates::follow_parameters() {
  for (; next_ < parameters_.size() && parameters_[next_].tick <= tick_; ++next_) {
    if (parameters_[next_].name == "MC_BAT_SCALE_EN") scales_ = parameters_[next_].value != 0;
  }
  ++tick_;
}

}  // namespace attest::ulog
