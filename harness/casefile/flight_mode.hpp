// Flight modes as the flags of vehicle_control_mode.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "harness/trace/module.hpp"

namespace attest {

struct FlightMode {
  std::string_view name;
  std::array<std::uint8_t, 6> flags;  // in the order of flag_names()

  // The flags while a VTOL is in transition: AUTO_* then does not control the velocity. REQUIRES: a
  // mode of the controller.
  std::array<std::uint8_t, 6> flags_in_transition() const;
};

// The flags of vehicle_control_mode that depend on the mode, in the profiles of this module.
const std::array<std::string_view, 6>& flag_names(Module module);

// The modes, with the flags that the firmware sets for a multicopter: for the controller those of
// PX4 v1.5.5's commander, for the units of the cascade those of v1.14 to v1.18.
std::span<const FlightMode> flight_modes(Module module);

// The entry of that name, or nullptr.
const FlightMode* find_flight_mode(Module module, std::string_view name);

}  // namespace attest
