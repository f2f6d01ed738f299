// The supported versions of the cascade, by name.
#pragma once

#include <array>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "controller/profile_range.hpp"

namespace attest::cascade {

enum class Profile { px4_v1_18, px4_v1_17, px4_v1_16_0, px4_v1_15_4, px4_v1_14_4 };

// Newest first, in the order of the enumerators.
inline constexpr std::array<Profile, 5> every_profile{Profile::px4_v1_18, Profile::px4_v1_17,
                                                      Profile::px4_v1_16_0, Profile::px4_v1_15_4,
                                                      Profile::px4_v1_14_4};

// The states of autotune in which the rates of its signal are added: roll, pitch, yaw and test.
using AutotuneStates = std::array<std::uint8_t, 4>;

// All differences between the profiles, except their parameters (parameters.hpp).
struct ProfileTraits {
  std::string_view name;
  std::string_view as_of;  // what was read, if it was not the final release; else empty
  AutotuneStates autotune_states;
  bool filters_yaw_torque;           // a low-pass after the rate law
  bool follows_hover_estimate;       // the throttle curve can use the estimated hover thrust; else
                                     // it uses MPC_THR_HOVER
  bool locks_yaw;                    // a centred yaw stick holds the heading, corrected by the
                                     // unaided heading; else the yaw stick is integrated
  bool spools_up;                    // arming and landing move the limits of the throttle stick's
                                     // thrust; else they are fixed, and the stick is mapped to 0..1
  bool latches_in_every_step;        // every step takes the attitude setpoint and the estimator's
                                     // reset; else only a step that controls the attitude does
  bool flies_own_setpoint_directly;  // the law gets the sticks' setpoint without a check; else only
                                     // if it is newer than the setpoint in use, like a topic's
  bool squares_heading;              // R00 in heading() is ww + xx - yy - zz; else 1 - 2 (yy + zz)
  bool weighs_low_pass;              // LowPass: (1 - a) s + a x; else s + a (x - s)
  bool reads_heading_good;           // a heading that is not good for control releases the yaw lock
  bool keeps_lost_correction;        // the yaw correction keeps its value while the unaided heading
                                     // is lost, and starts anew when it is back; else it is 0
  bool follows_reference_model;      // the law tracks a model that follows the attitude setpoint
};

// A new profile needs its traits here: the compiler warns if it has none.
constexpr ProfileTraits traits_of(Profile profile) {
  constexpr ProfileTraits v1_15_4{.name = "px4-v1.15.4",
                                  .as_of = "",
                                  .autotune_states = {2, 4, 6, 10},
                                  .filters_yaw_torque = false,
                                  .follows_hover_estimate = false,
                                  .locks_yaw = false,
                                  .spools_up = true,
                                  .latches_in_every_step = false,
                                  .flies_own_setpoint_directly = false,
                                  .squares_heading = false,
                                  .weighs_low_pass = false,
                                  .reads_heading_good = true,
                                  .keeps_lost_correction = false,
                                  .follows_reference_model = false};
  ProfileTraits traits = v1_15_4;
  switch (profile) {
    case Profile::px4_v1_18:
      traits = traits_of(Profile::px4_v1_17);
      traits.name = "px4-v1.18";
      traits.as_of = "branch release-1.18 (2026-08)";
      traits.reads_heading_good = false;
      traits.keeps_lost_correction = true;
      traits.follows_reference_model = true;
      return traits;
    case Profile::px4_v1_17:
      traits = traits_of(Profile::px4_v1_16_0);
      traits.name = "px4-v1.17";
      traits.as_of = "v1.17.0-beta1 (2026-01)";
      traits.autotune_states = {3, 6, 9, 13};
      return traits;
    case Profile::px4_v1_16_0:
      traits.name = "px4-v1.16.0";
      traits.filters_yaw_torque = true;
      traits.follows_hover_estimate = true;
      traits.locks_yaw = true;
      return traits;
    case Profile::px4_v1_15_4:
      return traits;
    case Profile::px4_v1_14_4:
      traits.name = "px4-v1.14.4";
      traits.spools_up = false;
      traits.latches_in_every_step = true;
      traits.flies_own_setpoint_directly = true;
      traits.squares_heading = true;
      traits.weighs_low_pass = true;
      return traits;
  }
  std::abort();  // the value is not an enumerator
}

using ProfileRange = attest::ProfileRange<Profile>;
inline constexpr Profile newest = every_profile.front(), oldest = every_profile.back();
inline constexpr ProfileRange all_profiles{newest, oldest};
inline constexpr ProfileRange from_v1_18{newest, Profile::px4_v1_18};
inline constexpr ProfileRange from_v1_17{newest, Profile::px4_v1_17};
inline constexpr ProfileRange until_v1_17{Profile::px4_v1_17, oldest};
inline constexpr ProfileRange until_v1_16_0{Profile::px4_v1_16_0, oldest};
inline constexpr ProfileRange only_v1_16_0{Profile::px4_v1_16_0, Profile::px4_v1_16_0};
inline constexpr ProfileRange from_v1_16_0{newest, Profile::px4_v1_16_0};
inline constexpr ProfileRange from_v1_15_4{newest, Profile::px4_v1_15_4};
inline constexpr ProfileRange until_v1_15_4{Profile::px4_v1_15_4, oldest};
inline constexpr ProfileRange only_v1_15_4{Profile::px4_v1_15_4, Profile::px4_v1_15_4};
inline constexpr ProfileRange only_v1_14_4{Profile::px4_v1_14_4, Profile::px4_v1_14_4};

constexpr std::string_view name_of(Profile profile) { return traits_of(profile).name; }
constexpr std::optional<Profile> profile_from_name(std::string_view name) {
  return profile_named(name, every_profile);
}

}  // namespace attest::cascade
