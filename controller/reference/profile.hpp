// The supported versions of the law, by name.
#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>
#include <optional>
#include <span>
#include <string_view>

namespace attest::reference {

enum class Profile { px4_v1_5_5, px4_v1_3_4 };

// Newest first.
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

// A set of profiles: those that have a certain parameter, or whose cases detect a certain fault.
class ProfileSet {
 public:
  constexpr ProfileSet(std::initializer_list<Profile> profiles)
      : ProfileSet(std::span(profiles.begin(), profiles.size())) {}
  constexpr explicit ProfileSet(std::span<const Profile> profiles) {
    for (const Profile profile : profiles) bits_ |= bit(profile);
  }
  constexpr bool contains(Profile profile) const { return (bits_ & bit(profile)) != 0; }

 private:
  static constexpr std::uint32_t bit(Profile profile) {
    return 1u << static_cast<unsigned>(profile);
  }
  std::uint32_t bits_ = 0;
};

// `first` and all newer profiles.
constexpr ProfileSet profiles_from(Profile first) {
  std::size_t count = 0;
  while (every_profile[count] != first) ++count;
  return ProfileSet(std::span(every_profile).first(count + 1));
}

inline constexpr ProfileSet all_profiles{std::span(every_profile)};
inline constexpr ProfileSet from_v1_5_5 = profiles_from(Profile::px4_v1_5_5);
inline constexpr ProfileSet only_v1_3_4{Profile::px4_v1_3_4};
static_assert(!from_v1_5_5.contains(Profile::px4_v1_3_4));

// In the order of every_profile.
std::span<const std::string_view> profile_names();
constexpr std::string_view name_of(Profile profile) { return traits_of(profile).name; }

std::optional<Profile> profile_from_name(std::string_view name);

}  // namespace attest::reference
