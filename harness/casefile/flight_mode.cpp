#include "harness/casefile/flight_mode.hpp"

namespace attest {

std::span<const FlightMode> flight_modes() {
  static constexpr FlightMode modes[] = {
      {"STABILIZED", {1, 0, 1, 1, 1, 0}},
      {"RATTITUDE", {1, 0, 1, 1, 1, 0}},
      {"ALTCTL", {1, 0, 1, 1, 0, 0}},
      {"POSCTL", {1, 0, 1, 1, 0, 1}},
      {"ACRO", {1, 0, 1, 0, 0, 0}},
      {"AUTO_MISSION", {0, 1, 1, 1, 0, 1}},
      {"AUTO_LOITER", {0, 1, 1, 1, 0, 1}},
      {"AUTO_RTL", {0, 1, 1, 1, 0, 1}},
      {"AUTO_TAKEOFF", {0, 1, 1, 1, 0, 1}},
      {"AUTO_LAND", {0, 1, 1, 1, 0, 1}},
      {"AUTO_FOLLOW_TARGET", {0, 1, 1, 1, 0, 1}},
      {"AUTO_RTGS", {0, 1, 1, 1, 0, 1}},
      {"AUTO_LANDENGFAIL", {0, 1, 1, 1, 0, 1}},
      {"AUTO_LANDGPSFAIL", {0, 0, 1, 1, 0, 0}},
      {"DESCEND", {0, 1, 1, 1, 0, 0}},
      {"TERMINATION", {0, 0, 0, 0, 0, 0}},
      {"OFFBOARD_ATTITUDE", {0, 0, 1, 1, 0, 0}},
      {"OFFBOARD_RATES", {0, 0, 1, 0, 0, 0}},
  };
  return modes;
}

std::array<std::uint8_t, 6> FlightMode::flags_in_transition() const {
  auto result = flags;
  if (name.starts_with("AUTO_")) result.back() = 0;  // velocity
  return result;
}

const FlightMode* find_flight_mode(std::string_view name) {
  for (const FlightMode& mode : flight_modes()) {
    if (mode.name == name) return &mode;
  }
  return nullptr;
}

}  // namespace attest
