#include "controller/cascade/profile.hpp"

namespace attest::cascade {

std::span<const std::string_view> profile_names() {
  static constexpr auto names = [] {
    std::array<std::string_view, every_profile.size()> all;
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = name_of(every_profile[i]);
    return all;
  }();
  return names;
}

std::optional<Profile> profile_from_name(std::string_view name) {
  for (const Profile profile : every_profile) {
    if (name_of(profile) == name) return profile;
  }
  return std::nullopt;
}

}  // namespace attest::cascade
