#include "controller/reference/profile.hpp"

#include <array>

namespace attest::reference {
namespace {

// In the order of the enumerators.
constexpr std::array<std::string_view, 2> all_names{"px4-v1.5.5", "px4-v1.3.4"};

}  // namespace

std::span<const std::string_view> profile_names() { return all_names; }

std::string_view name_of(Profile profile) { return all_names[static_cast<std::size_t>(profile)]; }

std::optional<Profile> profile_from_name(std::string_view name) {
  if (name == all_names[0]) return Profile::px4_v1_5_5;
  if (name == all_names[1]) return Profile::px4_v1_3_4;
  return std::nullopt;
}

}  // namespace attest::reference
