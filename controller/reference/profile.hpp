// The versions of the law that are known, by name.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string_view>

namespace attest::reference {

// v1.3.4 (June 2016) has no throttle attenuation, landing gear or battery scaling, feeds forward
// the change of the rate setpoint, and clamps yaw twice when weather-vaning.
enum class Profile { px4_v1_5_5, px4_v1_3_4 };

// Some of the profiles: those that have a parameter, or can tell a mistake.
class ProfileSet {
 public:
  constexpr ProfileSet(std::initializer_list<Profile> profiles) {
    for (const Profile profile : profiles) bits_ |= bit(profile);
  }
  constexpr bool contains(Profile profile) const { return (bits_ & bit(profile)) != 0; }

 private:
  static constexpr std::uint32_t bit(Profile profile) {
    return 1u << static_cast<unsigned>(profile);
  }
  std::uint32_t bits_ = 0;
};

inline constexpr ProfileSet all_profiles{Profile::px4_v1_5_5, Profile::px4_v1_3_4};
inline constexpr ProfileSet from_v1_5_5{Profile::px4_v1_5_5};
inline constexpr ProfileSet only_v1_3_4{Profile::px4_v1_3_4};

// "px4-v1.5.5", "px4-v1.3.4": newest first.
std::span<const std::string_view> profile_names();
std::string_view name_of(Profile profile);

std::optional<Profile> profile_from_name(std::string_view name);

}  // namespace attest::reference
