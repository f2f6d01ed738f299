#include "harness/casefile/flight_mode.hpp"

namespace attest {

namespace {

std::span<const FlightMode> modes_of_controller() {
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

std::span<const FlightMode> modes_of_cascade() {
  static constexpr FlightMode modes[] = {
      {"STABILIZED", {1, 0, 0, 0, 1, 1}},
      {"MANUAL", {1, 0, 0, 0, 1, 1}},
      {"ACRO", {1, 0, 0, 0, 0, 1}},
      {"ALTCTL", {1, 1, 0, 0, 1, 1}},
      {"POSCTL", {1, 1, 1, 1, 1, 1}},
      {"AUTO_MISSION", {0, 1, 1, 1, 1, 1}},
      {"AUTO_LOITER", {0, 1, 1, 1, 1, 1}},
      {"AUTO_RTL", {0, 1, 1, 1, 1, 1}},
      {"AUTO_LAND", {0, 1, 1, 1, 1, 1}},
      {"AUTO_TAKEOFF", {0, 1, 1, 1, 1, 1}},
      {"ORBIT", {0, 1, 1, 1, 1, 1}},
      {"AUTO_FOLLOW_TARGET", {0, 1, 1, 1, 1, 1}},
      {"OFFBOARD_POSITION", {0, 1, 1, 1, 1, 1}},
      {"OFFBOARD_VELOCITY", {0, 1, 1, 0, 1, 1}},
      {"DESCEND", {0, 0, 0, 0, 1, 1}},
      {"OFFBOARD_ACCELERATION", {0, 0, 0, 0, 1, 1}},
      {"OFFBOARD_ATTITUDE", {0, 0, 0, 0, 1, 1}},
      {"OFFBOARD_RATES", {0, 0, 0, 0, 0, 1}},
      {"OFFBOARD_THRUST_AND_TORQUE", {0, 0, 0, 0, 0, 0}},
      {"TERMINATION", {0, 0, 0, 0, 0, 0}},
  };
  return modes;
}

}  // namespace

const std::array<std::string_view, 6>& flag_names(Module module) {
  static constexpr std::array<std::string_view, 6> of_controller{
      "flag_control_manual_enabled",    "flag_control_auto_enabled",
      "flag_control_rates_enabled",     "flag_control_attitude_enabled",
      "flag_control_rattitude_enabled", "flag_control_velocity_enabled"};
  static constexpr std::array<std::string_view, 6> of_cascade{
      "flag_control_manual_enabled",   "flag_control_altitude_enabled",
      "flag_control_velocity_enabled", "flag_control_position_enabled",
      "flag_control_attitude_enabled", "flag_control_rates_enabled"};
  return info_of(module).is_of_cascade() ? of_cascade : of_controller;
}

std::span<const FlightMode> flight_modes(Module module) {
  return info_of(module).is_of_cascade() ? modes_of_cascade() : modes_of_controller();
}

std::array<std::uint8_t, 6> FlightMode::flags_in_transition() const {
  auto result = flags;
  if (name.starts_with("AUTO_")) result.back() = 0;  // velocity
  return result;
}

const FlightMode* find_flight_mode(Module module, std::string_view name) {
  for (const FlightMode& mode : flight_modes(module)) {
    if (mode.name == name) return &mode;
  }
  return nullptr;
}

}  // namespace attest
