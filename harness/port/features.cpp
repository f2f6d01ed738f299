#include "harness/port/features.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "harness/port/profiles.hpp"

namespace attest {
namespace {

constexpr std::array<FeatureInfo, feature_count> rows{{
    {"sticks", "the attitude unit makes the setpoint from the sticks (stabilized mode)"},
    {"acro", "the sticks command rates"},
    {"offboard_rates", "the controller follows a rates setpoint from outside"},
    {"rattitude", "a stick beyond MC_RATT_TH turns attitude control off"},
    {"estimator_reset", "the estimator has reset the attitude (quat_reset_counter)"},
    {"autotune", "autotune adds rates to the setpoint"},
    {"yaw_feed_forward", "yaw_sp_move_rate is not 0"},
    {"weathervane", "the wind may turn the nose (disable_mc_yaw_control)"},
    {"tailsitter", "VT_OPT_RECOV_EN is not 0, or the vehicle is a tailsitter"},
    {"vtol", "the vehicle is a VTOL"},
    {"rate_feed_forward", "a gain MC_...RATE_FF is not 0"},
    {"tpa", "the thrust is above MC_TPA_BREAK, so the rate gains are smaller"},
    {"saturation", "mixer or allocator reports saturation"},
    {"landing", "the vehicle is landed, may be, or it is not known"},
    {"arming", "the vehicle is not armed"},
    {"battery", "battery_status.scale is not 1, and MC_BAT_SCALE_EN is not 0"},
    {"mode_changes", "a flag of vehicle_control_mode changes"},
    {"parameter_changes", "a parameter changes while the unit runs"},
    {"non_finite", "an input or parameter is NaN or infinite"},
    {"instances", "a second instance exists in the process of the port, also after the first"},
}};

FeatureSet if_true(bool used, Feature feature) { return used ? only(feature) : FeatureSet(); }

template <typename Fields>
bool any_of(const Fields& fields) {
  return std::any_of(std::begin(fields), std::end(fields), [](auto field) { return field != 0; });
}

class Parameters {
 public:
  Parameters(Module module, std::string_view profile) {
    const ProfileInfo* const known = find_profile(profile);
    if (!known) return;
    for (const Parameter& one : parameters_of(module, *known)) {
      values_[std::string(one.name)] = one.default_value;
    }
  }

  void apply(std::span<const ParameterChange> changes) {
    for (const ParameterChange& change : changes) values_[change.name] = change.value;
  }

  // 0 if the profile does not have the parameter.
  float operator[](const std::string& name) const {
    const auto found = values_.find(name);
    return found == values_.end() ? 0 : found->second;
  }

 private:
  std::map<std::string, float> values_;
};

bool has_rate_feed_forward(const Parameters& parameters) {
  return std::ranges::any_of(std::array{"MC_ROLLRATE_FF", "MC_PITCHRATE_FF", "MC_YAWRATE_FF"},
                             [&](const char* name) { return parameters[name] != 0; });
}

bool is_scaled(float scale, const Parameters& parameters) {
  return scale != 1 && scale > 0 && parameters["MC_BAT_SCALE_EN"] != 0;
}

FeatureSet used_by(const attest_inputs& in, const Parameters& parameters) {
  const auto& mode = in.vehicle_control_mode;
  const auto& sticks = in.manual_control_setpoint;
  const bool by_rates = !mode.flag_control_attitude_enabled;
  const float threshold = parameters["MC_RATT_TH"];
  const bool is_beyond = std::abs(sticks.x) > threshold || std::abs(sticks.y) > threshold;
  const auto& limits = in.multirotor_motor_limits;
  // Beyond the threshold the law goes on as without attitude control.
  const bool is_rattitude = mode.flag_control_rattitude_enabled && is_beyond;
  const bool is_manual = mode.flag_control_manual_enabled;
  FeatureSet used = if_true((by_rates || is_rattitude) && is_manual, Feature::acro);
  used |= if_true((by_rates || is_rattitude) && !is_manual, Feature::offboard_rates);
  used |= if_true(is_rattitude, Feature::rattitude);
  used |= if_true(in.vehicle_attitude_setpoint.yaw_sp_move_rate != 0, Feature::yaw_feed_forward);
  used |= if_true(in.vehicle_attitude_setpoint.disable_mc_yaw_control, Feature::weathervane);
  used |= if_true(parameters["VT_OPT_RECOV_EN"] != 0, Feature::tailsitter);
  used |= if_true(in.vehicle_status.is_vtol, Feature::vtol);
  used |= if_true(has_rate_feed_forward(parameters), Feature::rate_feed_forward);
  const float thrust =
      std::max({in.vehicle_attitude_setpoint.thrust, in.vehicle_rates_setpoint.thrust, sticks.z});
  used |=
      if_true(parameters["MC_TPA_SLOPE"] != 0 && thrust > parameters["MC_TPA_BREAK"], Feature::tpa);
  used |= if_true(limits.lower_limit || limits.upper_limit || limits.yaw, Feature::saturation);
  used |= if_true(!in.actuator_armed.armed, Feature::arming);
  return used | if_true(is_scaled(in.battery_status.scale, parameters), Feature::battery);
}

FeatureSet used_by(const attest_attitude_inputs& in, const Parameters&) {
  const auto& mode = in.vehicle_control_mode;
  const auto& status = in.vehicle_status;
  const bool has_autopilot = mode.flag_control_altitude_enabled ||
                             mode.flag_control_velocity_enabled ||
                             mode.flag_control_position_enabled;
  FeatureSet used = if_true(mode.flag_control_manual_enabled && !has_autopilot, Feature::sticks);
  used |= if_true(in.vehicle_attitude.quat_reset_counter != 0, Feature::estimator_reset);
  used |= if_true(in.autotune_attitude_control_status.state != 0, Feature::autotune);
  used |= if_true(in.vehicle_attitude_setpoint.yaw_sp_move_rate != 0, Feature::yaw_feed_forward);
  used |= if_true(status.is_vtol_tailsitter, Feature::tailsitter);
  used |= if_true(status.is_vtol || status.in_transition_mode, Feature::vtol);
  used |= if_true(in.vehicle_land_detected.landed, Feature::landing);
  return used | if_true(!status.armed, Feature::arming);
}

FeatureSet used_by(const attest_rate_inputs& in, const Parameters& parameters) {
  const auto& mode = in.vehicle_control_mode;
  const auto& status = in.control_allocator_status;
  const bool is_acro = mode.flag_control_manual_enabled && !mode.flag_control_attitude_enabled;
  FeatureSet used = if_true(is_acro, Feature::acro);
  used |= if_true(has_rate_feed_forward(parameters), Feature::rate_feed_forward);
  used |= if_true(!status.torque_setpoint_achieved && any_of(status.unallocated_torque),
                  Feature::saturation);
  used |= if_true(in.vehicle_land_detected.landed || in.vehicle_land_detected.maybe_landed,
                  Feature::landing);
  used |= if_true(!mode.flag_armed, Feature::arming);
  return used | if_true(is_scaled(in.battery_status.scale, parameters), Feature::battery);
}

FeatureSet used_by(const attest_attitude_law_inputs& in) {
  return if_true(in.vehicle_attitude_setpoint.yaw_sp_move_rate != 0, Feature::yaw_feed_forward) |
         if_true(in.law.weathervane, Feature::weathervane);
}

FeatureSet used_by(const attest_rate_law_inputs& in) {
  const auto& limits = in.multirotor_motor_limits;
  const bool is_saturated = any_of(in.saturation.positive) || any_of(in.saturation.negative) ||
                            limits.lower_limit || limits.upper_limit || limits.yaw;
  const bool is_attenuated =
      in.rate_gains.tpa_slope != 0 && in.vehicle_rates_setpoint.thrust > in.rate_gains.tpa_break;
  return if_true(any_of(in.rate_gains.ff), Feature::rate_feed_forward) |
         if_true(is_saturated, Feature::saturation) | if_true(is_attenuated, Feature::tpa) |
         if_true(in.law.landed, Feature::landing);
}

FeatureSet used_at(const Sample& sample, Module module, const Parameters& parameters) {
  switch (module) {
    case Module::mc_att_control:
      return used_by(sample.in, parameters);
    case Module::attitude_unit:
      return used_by(sample.attitude_in, parameters);
    case Module::rate_unit:
      return used_by(sample.rate_in, parameters);
    case Module::attitude_law:
      return used_by(sample.attitude_law.in);
    case Module::rate_law:
      return used_by(sample.rate_law.in);
    case Module::mixer:
    case Module::battery_status:
      break;
  }
  return {};
}

// A topic that was never published has zeros, which say that the vehicle is not landed; the unit
// takes it as landed.
bool is_landed_before_first_sample(const Trace& trace, Module module) {
  const auto bit = find_channel(module, "in/updated.vehicle_land_detected");
  return bit && !trace.samples.empty() && value_of(channels()[*bit], trace.samples.front()) == 0;
}

// Of the inputs that a unit reads as numbers. A heading that is not finite means that there is
// none.
bool is_non_finite(const Channel& channel, const Sample& sample) {
  return channel.type == ChannelType::f32 && channel.field() != "unaided_heading" &&
         !std::isfinite(value_of(channel, sample));
}

}  // namespace

std::span<const FeatureInfo, feature_count> features() { return rows; }

std::optional<Feature> feature_named(std::string_view name) {
  const auto found = std::ranges::find(rows, name, &FeatureInfo::name);
  if (found == rows.end()) return std::nullopt;
  return static_cast<Feature>(found - rows.begin());
}

std::vector<std::string> names_of(const FeatureSet& set) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < feature_count; ++i) {
    if (set[i]) names.emplace_back(rows[i].name);
  }
  return names;
}

FeatureSet features_of(const Trace& trace, std::string_view profile) {
  const Module module = module_of(trace.present);
  std::vector<const Channel*> inputs, modes;
  for (const Channel& channel : channels()) {
    if (channel.module != module || channel.is_output()) continue;
    if (channel.type == ChannelType::f32) inputs.push_back(&channel);
    if (channel.topic() == "vehicle_control_mode" && channel.type == ChannelType::u8) {
      modes.push_back(&channel);
    }
  }
  Parameters parameters(module, profile);
  PendingChanges changes(trace.parameters);
  FeatureSet used = if_true(is_landed_before_first_sample(trace, module), Feature::landing);
  for (std::size_t tick = 0; tick < trace.samples.size(); ++tick) {
    const Sample& sample = trace.samples[tick];
    const auto due = changes.take_until(tick);
    parameters.apply(due);
    used |= used_at(sample, module, parameters);
    used |= if_true(tick > 0 && !due.empty(), Feature::parameter_changes);
    const bool has_non_finite =
        std::ranges::any_of(inputs, [&](auto* each) { return is_non_finite(*each, sample); }) ||
        std::ranges::any_of(due, [](const auto& change) { return !std::isfinite(change.value); });
    used |= if_true(has_non_finite, Feature::non_finite);
    if (tick == 0) continue;
    const bool changes_mode = std::ranges::any_of(modes, [&](const Channel* mode) {
      return !same_bits(*mode, sample, trace.samples[tick - 1]);
    });
    used |= if_true(changes_mode, Feature::mode_changes);
  }
  return used;
}

}  // namespace attest
