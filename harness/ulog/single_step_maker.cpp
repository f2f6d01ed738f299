#include "harness/ulog/single_step_maker.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>
#include <utility>

#include "harness/ulog/own_topics.hpp"

namespace attest::ulog {
namespace {

using Vector = float[3];

bool have_same_bits(const Vector& a, const Vector& b) { return std::memcmp(a, b, sizeof a) == 0; }

bool has_outputs_of_law(Module module, const Sample& tick) {
  const attest_rate_outputs& out = tick.rate_out;
  if (module == Module::attitude_unit) return tick.attitude_out.vehicle_rates_setpoint.published;
  return out.vehicle_torque_setpoint.published && out.vehicle_thrust_setpoint.published &&
         out.rate_ctrl_status.published;
}

// As if another module had published it just before the step.
void give_own_setpoint(SingleStep& step) {
  attest_attitude_inputs& in = step.sample.attitude_in;
  const auto& own = step.sample.attitude_out.vehicle_attitude_setpoint;
  auto& given = in.vehicle_attitude_setpoint;
  std::copy(std::begin(own.q_d), std::end(own.q_d), given.q_d);
  std::copy(std::begin(own.thrust_body), std::end(own.thrust_body), given.thrust_body);
  given.yaw_sp_move_rate = own.yaw_sp_move_rate;
  given.timestamp = in.timestamp;
  in.vehicle_control_mode.flag_control_manual_enabled = 0;
  step.setpoint = {Known::all, in.timestamp, true};
}

// The last one that the unit published, which it holds until a new sample of the sticks.
void give_acro_setpoint(std::uint64_t published_us, SingleStep& step) {
  attest_rate_inputs& in = step.sample.rate_in;
  const auto& own = step.sample.rate_out.vehicle_rates_setpoint;
  auto& given = in.vehicle_rates_setpoint;
  given.roll = own.roll;
  given.pitch = own.pitch;
  given.yaw = own.yaw;
  std::copy(std::begin(own.thrust_body), std::end(own.thrust_body), given.thrust_body);
  in.vehicle_control_mode.flag_control_manual_enabled = 0;
  step.setpoint = {Known::all, published_us};
}

bool is_known(const LoggedSetpoint& setpoint) {
  return setpoint.known != Known::nothing && setpoint.time_us > 0;
}

// A vehicle that is not armed, and one on the ground, has an integral of 0. Both, so that it is 0
// in a port that lacks one of them.
void hold_integral_at_0(attest_rate_inputs& in) {
  in.vehicle_control_mode.flag_armed = 0;
  in.vehicle_land_detected = {1, 1};
  in.updated |= ATTEST_RATE_UPDATED_VEHICLE_LAND_DETECTED;
}

}  // namespace

const char* text_of(Unfit why) {
  constexpr std::array texts{
      "before the first mode or setpoint of the log",
      "with sticks, and without the setpoint of the step",
      "with the thrust of another setpoint",
      "at a reset of the estimator",
      "in fixed-wing flight",
  };
  return texts[static_cast<std::size_t>(why)];
}

std::optional<SingleStep> SingleStepMaker::next(const Sample& tick,
                                                const LoggedSetpoint& setpoint) {
  updated_ |= tick.in.updated;
  follow_parameters();
  bool is_reset = false;
  if (module_ == Module::attitude_unit) {
    const std::uint8_t counter = tick.attitude_in.vehicle_attitude.quat_reset_counter;
    is_reset = std::exchange(last_counter_, counter).value_or(counter) != counter;
  } else {
    const auto& battery = tick.rate_in.battery_status;
    if (battery.connected != 0 && battery.scale > 0) scale_ = battery.scale;
    if (tick.rate_out.vehicle_rates_setpoint.published != 0) acro_us_ = tick.in.timestamp;
  }
  if (!has_outputs_of_law(module_, tick)) return std::nullopt;
  ++outputs_;
  SingleStep step{tick, setpoint};
  step.sample.in.updated = updated_;  // the step before may be left out, and with it its samples
  const auto unfit = module_ == Module::attitude_unit ? make_of_attitude_unit(is_reset, step)
                                                      : make_of_rate_unit(step);
  if (!unfit) return step;
  ++unfit_[*unfit];
  return std::nullopt;
}

std::optional<Unfit> SingleStepMaker::make_of_attitude_unit(bool is_reset, SingleStep& step) const {
  attest_attitude_inputs& in = step.sample.attitude_in;
  const attest_attitude_outputs& out = step.sample.attitude_out;
  if (is_reset) return Unfit::reset;
  in.vehicle_attitude.quat_reset_counter = 0;  // a reset turns older setpoints only
  if (is_of_sticks(step.sample)) {
    if (out.vehicle_attitude_setpoint.published == 0) return Unfit::no_own_setpoint;
    give_own_setpoint(step);
  }
  if (!is_known(step.setpoint)) return Unfit::nothing_known;
  in.updated |= ATTEST_ATTITUDE_UPDATED_VEHICLE_ATTITUDE_SETPOINT;
  const bool is_in_use = have_same_bits(in.vehicle_attitude_setpoint.thrust_body,
                                        out.vehicle_rates_setpoint.thrust_body);
  return is_in_use ? std::nullopt : std::optional(Unfit::other_thrust);
}

std::optional<Unfit> SingleStepMaker::make_of_rate_unit(SingleStep& step) const {
  attest_rate_inputs& in = step.sample.rate_in;
  if (!flies_by_rotors(module_, step.sample)) return Unfit::other_wings;
  if (is_acro(step.sample)) give_acro_setpoint(acro_us_, step);
  if (!is_known(step.setpoint)) return Unfit::nothing_known;
  hold_integral_at_0(in);
  in.updated |= ATTEST_RATE_UPDATED_VEHICLE_RATES_SETPOINT;
  // The unit scales by the last valid sample of the battery (LAW-CASCADE 6.10).
  auto& battery = in.battery_status;
  battery = {scale_, static_cast<std::uint8_t>(scales_ && scale_ > 0 ? 1 : 0)};
  Vector thrust;
  for (std::size_t axis = 0; axis < std::size(thrust); ++axis) {
    thrust[axis] = in.vehicle_rates_setpoint.thrust_body[axis];
    if (battery.connected) thrust[axis] = std::clamp(thrust[axis] * battery.scale, -1.0F, 1.0F);
  }
  const bool is_in_use = have_same_bits(thrust, step.sample.rate_out.vehicle_thrust_setpoint.xyz);
  return is_in_use ? std::nullopt : std::optional(Unfit::other_thrust);
}

void SingleStepFinder::next(const Sample& tick, const LoggedSetpoint& setpoint) {
  // 20,000 are 8 MB; the default log of half an hour has fewer.
  constexpr std::size_t most_in_memory = 20'000;
  auto step = maker_.next(tick, setpoint);
  ++tick_;
  if (!step) return;
  while (parameters_.size() < changes_.size() && changes_[parameters_.size()].tick < tick_) {
    parameters_.push_back(changes_[parameters_.size()]);
    parameters_.back().tick = steps_;
  }
  with_own_setpoint_ += step->setpoint.is_own ? 1 : 0;
  if (++steps_ <= most_in_memory) {
    in_memory_.push_back(*step);
  } else if (!in_memory_.empty()) {
    std::vector<SingleStep>().swap(in_memory_);
  }
}

void SingleStepMaker::follow_parameters() {
  for (; next_ < parameters_.size() && parameters_[next_].tick <= tick_; ++next_) {
    if (parameters_[next_].name == "MC_BAT_SCALE_EN") scales_ = parameters_[next_].value != 0;
  }
  ++tick_;
}

}  // namespace attest::ulog
