// The versions of a law. Each law has an enumeration of its versions, and an array of all of them:
// newest first, in the order of the enumerators.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace attest {

// Successive versions: those that have a certain parameter, or whose cases detect a certain fault.
template <typename Profile>
struct ProfileRange {
  Profile newest;
  Profile oldest;
  constexpr bool contains(Profile profile) const { return newest <= profile && profile <= oldest; }
};

// The version of which name_of() is `name`.
template <typename Profile, std::size_t count>
constexpr std::optional<Profile> profile_named(std::string_view name,
                                               const std::array<Profile, count>& all) {
  for (const Profile profile : all) {
    if (name_of(profile) == name) return profile;
  }
  return std::nullopt;
}

}  // namespace attest
