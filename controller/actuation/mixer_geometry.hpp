// The rotor layouts that the mixer knows. PX4 v1.5.5 multirotor geometries.
#pragma once

#include <span>
#include <string_view>

#include "controller/actuation/mixer.hpp"

namespace attest::actuation {

struct MixerGeometry {
  std::string_view name;
  std::span<const Rotor> rotors;
};

std::span<const MixerGeometry> mixer_geometries();

}  // namespace attest::actuation
