#include "controller/faults/fault.hpp"

#include <array>
#include <vector>

#include "controller/faults/groups.hpp"

namespace attest::faults {

std::string_view name_of(Stage stage) {
  // In the order of the enumerators.
  constexpr std::array<std::string_view, 26> names{"input",
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
                                                   "battery status"};
  return names[static_cast<std::size_t>(stage)];
}

namespace {

// Faults of one subject, and the profiles whose law has that subject.
struct Subject {
  std::span<const Fault> faults;
  reference::ProfileSet profiles = reference::all_profiles;
};

std::vector<Fault> all_faults() {
  using reference::from_v1_5_5;
  std::vector<Fault> all;
  for (const auto& [faults, profiles] : {Subject{attitude_faults()},
                                         Subject{yaw_faults()},
                                         Subject{large_angle_faults()},
                                         Subject{rate_limit_faults()},
                                         Subject{yaw_feed_forward_faults()},
                                         Subject{weathervane_faults()},
                                         Subject{rate_faults()},
                                         Subject{tpa_faults(), from_v1_5_5},
                                         Subject{anti_windup_faults()},
                                         Subject{battery_faults(), from_v1_5_5},
                                         Subject{mode_faults()},
                                         Subject{arming_faults()},
                                         Subject{parameter_faults()},
                                         Subject{timing_faults()},
                                         Subject{robustness_faults()},
                                         Subject{tailsitter_faults()},
                                         Subject{actuator_faults()},
                                         Subject{v1_3_4_faults()},
                                         Subject{mixer_faults(), from_v1_5_5},
                                         Subject{mixer_fit_faults(), from_v1_5_5},
                                         Subject{battery_status_faults(), from_v1_5_5}}) {
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
