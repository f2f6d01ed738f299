#include "harness/port/profiles.hpp"

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "controller/actuation/battery_status.hpp"
#include "controller/actuation/unit_table.hpp"
#include "controller/cascade/parameters.hpp"
#include "controller/mc_att_control/parameters.hpp"
#include "harness/core/suggestion.hpp"

namespace attest {
namespace {

ProfileInfo profile_of(std::string_view name, std::initializer_list<Profiles> having) {
  ProfileInfo profile{name, {}, {}};
  for (const ModuleInfo& info : modules()) {
    if (std::ranges::find(having, info.profiles) != having.end()) {
      profile.modules |= only(info.module);
    }
  }
  return profile;
}

std::vector<ProfileInfo> make_profiles() {
  using enum Profiles;
  std::vector<ProfileInfo> all_profiles;
  for (const mc_att_control::Profile profile : mc_att_control::every_profile) {
    const std::string_view name = mc_att_control::name_of(profile);
    all_profiles.push_back(actuation::is_profile(name.data())
                               ? profile_of(name, {with_controller, only_v1_5_5, all})
                               : profile_of(name, {with_controller, all}));
  }
  for (const cascade::Profile profile : cascade::every_profile) {
    all_profiles.push_back(profile_of(cascade::name_of(profile), {with_cascade, all}));
    all_profiles.back().as_of = cascade::traits_of(profile).as_of;
  }
  return all_profiles;
}

// The parameters of `profile` in a table whose rows name their profiles.
template <typename Table, typename Profile>
std::vector<Parameter> rows_of(const Table& table, Profile profile) {
  std::vector<Parameter> parameters;
  for (const auto& row : table) {
    if (!row.profiles.contains(profile)) continue;
    parameters.push_back({row.name, row.default_value, row.min, row.max, row.unit, row.description,
                          row.type == decltype(row.type)::integer});
  }
  return parameters;
}

std::vector<Parameter> battery_parameters() {
  constexpr float any = std::numeric_limits<float>::infinity();
  std::vector<Parameter> parameters;
  for (const auto& row : actuation::battery_parameters()) {
    parameters.push_back(
        {row.name, row.default_value, -any, any, row.unit, row.description, false});
  }
  return parameters;
}

// When a parameter has a name, seen from a profile in which it has another: "since px4-v1.17".
template <typename Range>
std::string when(const Range& range, const Range& of_other_name) {
  if (range.newest == range.oldest) return fmt::format("in {}", name_of(range.oldest));
  return range.oldest < of_other_name.oldest ? fmt::format("since {}", name_of(range.oldest))
                                             : fmt::format("until {}", name_of(range.newest));
}

// The name that the profile has for the parameter that other profiles call `name`.
template <typename Table, typename Profile>
std::string other_name(const Table& table, Profile profile, std::string_view name) {
  for (const auto& known : table) {
    if (known.name != name) continue;
    for (const auto& row : table) {
      if (row.member != known.member || row.name == name) continue;
      if (!row.profiles.contains(profile)) continue;
      return fmt::format("; it is `{}` {}", row.name, when(row.profiles, known.profiles));
    }
  }
  return "";
}

}  // namespace

std::span<const ProfileInfo> known_profiles() {
  static const std::vector<ProfileInfo> all = make_profiles();
  return all;
}

std::vector<std::string> known_profile_names() {
  std::vector<std::string> names;
  for (const ProfileInfo& profile : known_profiles()) names.emplace_back(profile.name);
  return names;
}

const ProfileInfo* find_profile(std::string_view name) {
  const auto all = known_profiles();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const ProfileInfo& one) { return one.name == name; });
  return found == all.end() ? nullptr : &*found;
}

std::vector<std::string> profiles_of_law(std::string_view profile) {
  ModuleSet units;
  for (const ModuleInfo& info : modules())
    units[static_cast<std::size_t>(info.module)] = info.is_unit();
  const ProfileInfo* const one = find_profile(profile);
  std::vector<std::string> names;
  for (const ProfileInfo& other : known_profiles()) {
    if (one && (other.modules & one->modules & units).any()) names.emplace_back(other.name);
  }
  return names;
}

bool makes_any_of(Port& port, const std::string& profile, std::optional<Module> but) {
  const ProfileInfo* const known = find_profile(profile);
  const ModuleSet own = (known ? known->modules : only(Module::mc_att_control)) & port.modules();
  const auto all = modules();
  return std::any_of(all.begin(), all.end(), [&](const ModuleInfo& info) {
    const bool is_asked = contains(own, info.module) && info.has_law();
    return is_asked && info.module != but && port.create_unit(info.module, profile, "") != nullptr;
  });
}

std::vector<Parameter> parameters_of(Module module, const ProfileInfo& profile) {
  if (!contains(profile.modules, module)) return {};
  switch (module) {
    case Module::mc_att_control:
      return rows_of(mc_att_control::parameter_table(),
                     *mc_att_control::profile_from_name(profile.name));
    case Module::battery_status:
      return battery_parameters();
    case Module::attitude_unit:
      return rows_of(cascade::attitude_parameters(), *cascade::profile_from_name(profile.name));
    case Module::rate_unit:
      return rows_of(cascade::rate_parameters(), *cascade::profile_from_name(profile.name));
    default:
      return {};
  }
}

std::string hint_for_parameter(const std::string& name, std::string_view profile,
                               const std::vector<std::string>& known) {
  const auto of_cascade = cascade::profile_from_name(profile);
  if (of_cascade) {
    const std::string renamed = other_name(cascade::attitude_parameters(), *of_cascade, name);
    if (!renamed.empty()) return renamed;
  }
  return suggestion(name, known);
}

std::vector<std::string> parameter_names(Module module, std::string_view profile) {
  const ProfileInfo* const known = find_profile(profile);
  std::vector<std::string> names;
  std::set<std::string_view> seen;
  for (const ProfileInfo& one : known_profiles()) {
    if (known != nullptr && known != &one) continue;
    for (const Parameter& parameter : parameters_of(module, one)) {
      if (seen.insert(parameter.name).second) names.emplace_back(parameter.name);
    }
  }
  return names;
}

}  // namespace attest
