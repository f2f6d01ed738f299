// The rotor layouts that the mixer supports: PX4 v1.5.5 multirotor geometries.
#pragma once

#include <span>
#include <string_view>

namespace attest::actuation {

// The share of each control in the output of one motor.
struct Rotor {
  float roll;
  float pitch;
  float yaw;  // +1 turns counter-clockwise seen from above, -1 clockwise
};

struct MixerGeometry {
  std::string_view name;
  std::span<const Rotor> rotors;
};

std::span<const MixerGeometry> mixer_geometries();

}  // namespace attest::actuation
