// The features of the law that a port may lack. A vector has a feature if its inputs or parameters
// use it at a tick, whatever its group.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/trace/trace.hpp"

namespace attest {

// In the order of features().
enum class Feature : std::uint8_t {
  sticks,
  acro,
  offboard_rates,
  rattitude,
  estimator_reset,
  autotune,
  yaw_feed_forward,
  weathervane,
  tailsitter,
  vtol,
  rate_feed_forward,
  tpa,
  saturation,
  landing,
  arming,
  battery,
  mode_changes,
  parameter_changes,
  non_finite,
  instances,
};
inline constexpr auto feature_count = static_cast<std::size_t>(Feature::instances) + 1;
using FeatureSet = std::bitset<feature_count>;  // by enumerator
inline FeatureSet only(Feature feature) {
  return FeatureSet().set(static_cast<std::size_t>(feature));
}
inline bool contains(const FeatureSet& set, Feature feature) {
  return set[static_cast<std::size_t>(feature)];
}

struct FeatureInfo {
  std::string_view name;  // "yaw_feed_forward", as a port declares it
  std::string_view what;  // when a tick uses it
};

std::span<const FeatureInfo, feature_count> features();
std::optional<Feature> feature_named(std::string_view name);
std::vector<std::string> names_of(const FeatureSet& set);

// The features that the inputs and parameters of the trace use; Feature::instances is none of them.
// A parameter that the trace does not set has the default of the profile. REQUIRES: the trace has
// all inputs of its module.
FeatureSet features_of(const Trace& trace, std::string_view profile);

}  // namespace attest
