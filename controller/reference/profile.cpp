#include "controller/reference/profile.hpp"

#include <array>

namespace attest::reference {
namespace {

// In the order of the enumerators.
constexpr std::array<std::string_view, 2> kNames{"px4-v1.5.5", "px4-v1.3.4"};

}  // namespace

std::span<const std::string_view> profile_names() { return kNames; }

std::optional<Profile> profile_from_name(std::string_view name) {
  if (name == kNames[0]) return Profile::kPx4V1_5_5;
  if (name == kNames[1]) return Profile::kPx4V1_3_4;
  return std::nullopt;
}

}  // namespace attest::reference
