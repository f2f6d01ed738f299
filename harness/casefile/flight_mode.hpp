// Flight modes as the flags of vehicle_control_mode.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace attest {

struct FlightMode {
  std::string_view name;
  // manual, auto, rates, attitude, rattitude, velocity: in the order of the channel table.
  std::array<std::uint8_t, 6> flags;

  // The flags while a VTOL is in transition: AUTO_* then does not control the velocity.
  std::array<std::uint8_t, 6> flags_in_transition() const;
};

// The modes of PX4 v1.5.5's commander, with the flags it sets for a multicopter.
std::span<const FlightMode> flight_modes();

// The entry of that name, or nullptr.
const FlightMode* find_flight_mode(std::string_view name);

}  // namespace attest
