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

std::span<const Fault* const> catalogue() {
  static const std::vector<const Fault*> all = [] {
    std::vector<const Fault*> list;
    for (const auto& part : {attitude_faults(),
                             yaw_faults(),
                             large_angle_faults(),
                             rate_limit_faults(),
                             yaw_feed_forward_faults(),
                             weathervane_faults(),
                             rate_faults(),
                             tpa_faults(),
                             anti_windup_faults(),
                             battery_faults(),
                             mode_faults(),
                             arming_faults(),
                             parameter_faults(),
                             timing_faults(),
                             robustness_faults(),
                             tailsitter_faults(),
                             actuator_faults(),
                             mixer_faults(),
                             mixer_fit_faults(),
                             battery_status_faults()}) {
      for (const Fault& fault : part) list.push_back(&fault);
    }
    return list;
  }();
  return all;
}

const Fault* find_fault(std::string_view id) {
  for (const Fault* fault : catalogue()) {
    if (fault->id == id) return fault;
  }
  return nullptr;
}

}  // namespace attest::faults
