#include "harness/verify/controls_without_memory.hpp"

#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "controller/mc_att_control/profile.hpp"
#include "harness/port/profiles.hpp"

namespace attest {
namespace {

struct Axis {
  const char* name;
  const char *d_gain, *feed_forward;
  std::size_t control;
};
constexpr Axis axes[] = {{"roll", "MC_ROLLRATE_D", "MC_ROLLRATE_FF", 0},
                         {"pitch", "MC_PITCHRATE_D", "MC_PITCHRATE_FF", 1},
                         {"yaw", "MC_YAWRATE_D", "MC_YAWRATE_FF", 2}};

// Whether the parameter is not 0 at some time.
bool any_is_set(std::string_view name, const ProfileInfo& profile,
                const std::vector<ParameterChange>& changes) {
  float value = 0;
  for (const Parameter& parameter : parameters_of(Module::mc_att_control, profile)) {
    if (parameter.name == name) value = parameter.default_value;
  }
  bool any = false, begins = true;
  for (const ParameterChange& change : changes) {
    if (change.name != name) continue;
    if (change.tick > 0 && begins) any = any || value != 0;
    begins = false;
    any = any || change.value != 0;
  }
  return begins ? value != 0 : any;
}

}  // namespace

ControlsWithoutMemory::ControlsWithoutMemory(const LoggedUnit& log, const std::string& profile,
                                             const LogParameters& parameters) {
  const ProfileInfo* const known = find_profile(profile);
  if (log.module != Module::mc_att_control || !known) return;
  channels = channels_of(log.module, "out/actuator_controls_0.") & log.trace.present;
  const auto law = mc_att_control::profile_from_name(profile);
  const bool feeds_change = law && !mc_att_control::traits_of(*law).feeds_forward_rates;
  const auto is_set = [&](const char* gain) {
    return any_is_set(gain, *known, parameters.as_flown) ||
           any_is_set(gain, *known, parameters.of_port);
  };
  std::vector<std::string> names;
  for (const Axis& axis : axes) {
    const bool remembers = is_set(axis.d_gain) || (feeds_change && is_set(axis.feed_forward));
    const auto control =
        find_channel(log.module, fmt::format("out/actuator_controls_0.control[{}]", axis.control));
    if (remembers) channels.reset(*control);
    if (!remembers && channels[*control]) names.emplace_back(axis.name);
  }
  if (names.empty()) channels.reset();
  condition = fmt::format("{} and thrust, while the integrals are 0", fmt::join(names, ", "));
}

}  // namespace attest
