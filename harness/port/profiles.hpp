// The versions of the law that attest knows, the modules of each, and their parameters.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/port/port.hpp"
#include "harness/trace/module.hpp"

namespace attest {

struct ProfileInfo {
  std::string_view name;  // "px4-v1.5.5"
  ModuleSet modules;      // those of this version that attest knows
  // What was read instead, if the version was not released yet: "v1.17.0-beta1 (2026-01)".
  std::string_view as_of;
};

// Every profile: those of the controller, then those of the cascade, each newest first.
std::span<const ProfileInfo> known_profiles();
std::vector<std::string> known_profile_names();

// Returns null if no profile has that name.
const ProfileInfo* find_profile(std::string_view name);

// The profiles of the law to which `profile` belongs, newest first. Empty if no profile has that
// name.
std::vector<std::string> profiles_of_law(std::string_view profile);

// True if the port makes a unit or a pure law of that profile, other than the module `but`. If
// attest does not know the profile, only a controller is tried.
bool makes_any_of(Port& port, const std::string& profile, std::optional<Module> but = {});

// A parameter of a module.
struct Parameter {
  std::string_view name;
  float default_value;
  float min, max;         // the law does not enforce them; infinite if there is no bound
  std::string_view unit;  // "1" when dimensionless
  std::string_view description;
  bool is_integer;
};

// The parameters of a module in a profile, in the order of the law's own table. Empty if the
// profile does not have the module.
std::vector<Parameter> parameters_of(Module module, const ProfileInfo& profile);

// The end of an error about a parameter that is not among the `known` ones of the profile: the name
// that it has in this profile ("; it is `MAN_DEADZONE` since px4-v1.17"), or one that is spelled
// almost the same ("; did you mean `MC_ROLL_P`?"). Empty if there is neither.
std::string hint_for_parameter(const std::string& name, std::string_view profile,
                               const std::vector<std::string>& known);

// The names of a module's parameters. If the profile is not known, those of all profiles.
std::vector<std::string> parameter_names(Module module, std::string_view profile);

}  // namespace attest
