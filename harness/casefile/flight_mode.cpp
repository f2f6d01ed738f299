#include "harness/casefile/flight_mode.hpp"

namespace attest {

std::span<const FlightMode> flight_modes() {
  // velocity is 0 in AUTO_* while a VTOL is in transition: such a case sets the flags themselves.
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
      {"AUTO_LANDGPSFAIL", {0, 0, 1, 1, 0, 0}},
      {"DESCEND", {0, 1, 1, 1, 0, 0}},
      {"TERMINATION", {0, 0, 0, 0, 0, 0}},
      {"OFFBOARD_ATTITUDE", {0, 0, 1, 1, 0, 0}},
      {"OFFBOARD_RATES", {0, 0, 1, 0, 0, 0}},
  };
  return modes;
}

const FlightMode* find_flight_mode(std::string_view name) {
  for (const FlightMode& mode : flight_modes()) {
    if (mode.name == name) return &mode;
  }
  return nullptr;
}

}  // namespace attest
