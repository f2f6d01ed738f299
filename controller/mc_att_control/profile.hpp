// The supported versions of the law, by name.
#pragma once

#include <array>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "controller/profile_range.hpp"

namespace attest::mc_att_control {

enum class Profile { px4_v1_5_5, px4_v1_3_4 };

// Newest first, in the order of the enumerators.
inline constexpr std::array<Profile, 2> every_profile{Profile::px4_v1_5_5, Profile::px4_v1_3_4};

// All differences between the profiles, except their parameters (parameters.hpp).
struct ProfileTraits {
  std::string_view name;
  bool attenuates_by_throttle;          // throttle reduces the proportional rate gain (TPA)
  bool feeds_forward_rates;             // the rates setpoint itself; else its rate of change
  bool freezes_yaw_integral;            // while the mixer reports yaw at its limit
  bool limits_yaw_before_feed_forward;  // when weather-vaning; every profile also limits it after
  bool limits_rates_in_auto;            // auto modes without velocity control count as autonomous,
                                        // too: for the limits of the rates and weather-vaning
  bool has_landing_gear;
  bool scales_by_battery;
};

// A new profile needs its traits here: the compiler warns if it has none.
constexpr ProfileTraits traits_of(Profile profile) {
  switch (profile) {
    case Profile::px4_v1_5_5:
      return {.name = "px4-v1.5.5",
              .attenuates_by_throttle = true,
              .feeds_forward_rates = true,
              .freezes_yaw_integral = true,
              .limits_yaw_before_feed_forward = false,
              .limits_rates_in_auto = true,
              .has_landing_gear = true,
              .scales_by_battery = true};
    case Profile::px4_v1_3_4:  // of June 2016
      return {.name = "px4-v1.3.4",
              .attenuates_by_throttle = false,
              .feeds_forward_rates = false,
              .freezes_yaw_integral = false,
              .limits_yaw_before_feed_forward = true,
              .limits_rates_in_auto = false,
              .has_landing_gear = false,
              .scales_by_battery = false};
  }
  std::abort();  // the value is not an enumerator
}

using ProfileRange = attest::ProfileRange<Profile>;
inline constexpr Profile newest = every_profile.front(), oldest = every_profile.back();
inline constexpr ProfileRange all_profiles{newest, oldest};
inline constexpr ProfileRange from_v1_5_5{newest, Profile::px4_v1_5_5};
inline constexpr ProfileRange only_v1_3_4{Profile::px4_v1_3_4, Profile::px4_v1_3_4};

constexpr std::string_view name_of(Profile profile) { return traits_of(profile).name; }
constexpr std::optional<Profile> profile_from_name(std::string_view name) {
  return profile_named(name, every_profile);
}

}  // namespace attest::mc_att_control
