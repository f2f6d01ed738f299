// The versions of the law that are known, by name.
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace attest::reference {

// v1.3.4 (June 2016) has no throttle attenuation, landing gear or battery scaling, feeds forward
// the change of the rate setpoint, and clamps yaw twice when weather-vaning.
enum class Profile { px4_v1_5_5, px4_v1_3_4 };

// "px4-v1.5.5", "px4-v1.3.4": newest first.
std::span<const std::string_view> profile_names();

std::optional<Profile> profile_from_name(std::string_view name);

}  // namespace attest::reference
