#include "controller/faults/fault.hpp"

#include <array>
#include <vector>

#include "controller/faults/groups.hpp"

namespace attest::faults {

std::string_view name_of(Stage stage) {
  // In the order of the enumerators.
  constexpr std::array<std::string_view, 36> names{"input",
                                                   "tilt",
                                                   "yaw",
                                                   "blend",
                                                   "limit",
                                                   "feed-forward",
                                                   "weather-vane",
                                                   "TPA",
                                                   "P",
                                                   "I",
                                                   "D",
                                                   "FF",
                                                   "integrator gate",
                                                   "guard",
                                                   "scaling",
                                                   "mode",
                                                   "arming",
                                                   "parameters",
                                                   "timing",
                                                   "recovery",
                                                   "output",
                                                   "mixer scaling",
                                                   "mixer fit",
                                                   "mixer yaw",
                                                   "mixer output",
                                                   "battery status",
                                                   "sticks",
                                                   "yaw lock",
                                                   "throttle",
                                                   "latching",
                                                   "estimator reset",
                                                   "autotune",
                                                   "saturation",
                                                   "yaw filter",
                                                   "reference model",
                                                   "elementary functions"};
  return names[static_cast<std::size_t>(stage)];
}

bool ProfileSet::contains(std::string_view profile) const {
  if (controller_) {
    const auto known = mc_att_control::profile_from_name(profile);
    return known && controller_->contains(*known);
  }
  const auto known = cascade::profile_from_name(profile);
  return known && cascade_->contains(*known);
}

bool ProfileSet::is_of_law_of(std::string_view profile) const {
  return controller_ ? mc_att_control::profile_from_name(profile).has_value()
                     : cascade::profile_from_name(profile).has_value();
}

namespace {

// Faults of one subject, and the profiles whose law has that subject.
struct Subject {
  std::span<const Fault> faults;
  ProfileSet profiles = mc_att_control::all_profiles;
};

constexpr auto from_v1_5_5 = mc_att_control::from_v1_5_5;
constexpr auto cascades = cascade::all_profiles;
constexpr auto from_v1_16_0 = cascade::from_v1_16_0;
constexpr auto from_v1_18 = cascade::from_v1_18;

// In the order of the catalogue.
std::vector<Subject> subjects() {
  return {{attitude_faults()},
          {yaw_faults()},
          {large_angle_faults()},
          {rate_limit_faults()},
          {yaw_feed_forward_faults()},
          {weathervane_faults()},
          {rate_faults()},
          {tpa_faults(), from_v1_5_5},
          {anti_windup_faults()},
          {battery_faults(), from_v1_5_5},
          {mode_faults()},
          {arming_faults()},
          {parameter_faults()},
          {timing_faults()},
          {robustness_faults()},
          {tailsitter_faults()},
          {actuator_faults()},
          {v1_3_4_faults()},
          {mixer_faults(), from_v1_5_5},
          {mixer_fit_faults(), from_v1_5_5},
          {battery_status_faults(), from_v1_5_5},
          {in_cascade::attitude_faults(), cascades},
          {in_cascade::large_angle_faults(), cascades},
          {in_cascade::yaw_weight_faults(), cascades},
          {in_cascade::yaw_feed_forward_faults(), cascade::until_v1_17},
          {in_cascade::model_faults(), from_v1_18},
          {in_cascade::model_yaw_faults(), from_v1_18},
          {in_cascade::model_forward_faults(), from_v1_18},
          {in_cascade::model_state_faults(), from_v1_18},
          {in_cascade::stick_faults(), cascades},
          {in_cascade::yaw_lock_faults(), from_v1_16_0},
          {in_cascade::lost_heading_faults(), from_v1_18},
          {in_cascade::throttle_faults(), cascades},
          {in_cascade::spool_up_faults(), cascade::from_v1_15_4},
          {in_cascade::reset_faults(), cascades},
          {in_cascade::attitude_mode_faults(), cascades},
          {in_cascade::guard_faults(), cascades},
          {in_cascade::torque_faults(), cascades},
          {in_cascade::integral_faults(), cascades},
          {in_cascade::rate_mode_faults(), cascades},
          {in_cascade::yaw_filter_faults(), from_v1_16_0},
          {in_cascade::battery_faults(), cascades},
          {in_cascade::parameter_faults(), cascades},
          {in_cascade::timing_faults(), cascades},
          {in_cascade::axis_faults(), cascades},
          {in_cascade::signal_faults(), cascades},
          {in_cascade::step_faults(), cascades},
          {in_cascade::formula_faults(), cascades},
          {in_cascade::filter_faults(), cascades}};
}

std::vector<Fault> all_faults() {
  std::vector<Fault> all;
  for (const auto& [faults, profiles] : subjects()) {
    for (Fault fault : faults) {
      if (!fault.profiles) fault.profiles = profiles;
      all.push_back(fault);
    }
  }
  return all;
}

}  // namespace

std::span<const Fault* const> catalogue() {
  static const std::vector<Fault> all = all_faults();
  static const std::vector<const Fault*> pointers = [] {
    std::vector<const Fault*> list;
    for (const Fault& fault : all) list.push_back(&fault);
    return list;
  }();
  return pointers;
}

const Fault* find_fault(std::string_view id) {
  for (const Fault* fault : catalogue()) {
    if (fault->id == id) return fault;
  }
  return nullptr;
}

}  // namespace attest::faults
