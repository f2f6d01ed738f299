// A table of the parameters of a law: names, defaults, bounds, units and meanings.
#pragma once

#include <cmath>
#include <span>
#include <string_view>

namespace attest {

enum class ParameterType { real, integer };

// A row. `all`: the ProfileRange of all versions of the law, to which a row applies unless it says
// otherwise. If default or bounds of a parameter differ between versions, it has several rows.
template <typename Parameters, auto all>
struct ParameterInfo {
  std::string_view name;
  float Parameters::*member;
  float default_value;
  float min;
  float max;              // infinity if there is no upper bound
  std::string_view unit;  // "1" when dimensionless
  ParameterType type;
  std::string_view description;
  decltype(all) profiles = all;

  bool is_int() const { return type == ParameterType::integer; }
};

template <typename Parameters, auto all>
using ParameterTable = std::span<const ParameterInfo<Parameters, all>>;

// The row of that name for that profile, or nullptr if the profile has no such parameter.
template <typename Parameters, auto all, typename Profile>
const ParameterInfo<Parameters, all>* find_parameter(ParameterTable<Parameters, all> table,
                                                     Profile profile, std::string_view name) {
  for (const auto& info : table) {
    if (info.name == name && info.profiles.contains(profile)) return &info;
  }
  return nullptr;
}

// The values of a new unit. Parameters that the profile does not have in this table are 0.
template <typename Parameters, auto all, typename Profile>
Parameters default_parameters(ParameterTable<Parameters, all> table, Profile profile) {
  Parameters parameters{};
  for (const auto& info : table) {
    if (info.profiles.contains(profile)) parameters.*info.member = info.default_value;
  }
  return parameters;
}

// Sets one value by name. Returns false and changes no value if the profile has no parameter of
// that name, or if the parameter is an integer and the value is not a whole number.
template <typename Parameters, auto all, typename Profile>
bool set_parameter(Parameters& parameters, ParameterTable<Parameters, all> table, Profile profile,
                   std::string_view name, float value) {
  const auto* const info = find_parameter(table, profile, name);
  if (info == nullptr) return false;
  const bool is_integer = std::isfinite(value) && std::trunc(value) == value;
  if (info->is_int() && !is_integer) return false;
  parameters.*info->member = value;
  return true;
}

}  // namespace attest
