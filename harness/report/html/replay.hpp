// The attitudes of a flight, for the animation on its page.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace attest {

// w, x, y, z over time. The quaternions rotate from the body (forward, right, down) to the world
// (north, east, down).
using Quaternions = std::array<std::vector<float>, 4>;

// One of the vehicles of an animation. REQUIRES: all sizes are equal, and at least 1.
struct ReplayVehicle {
  std::string name;          // may be empty for a single vehicle
  std::vector<float> times;  // [s] from the first tick
  Quaternions attitude;
  Quaternions setpoint;  // zeros: no setpoint at that time
};

}  // namespace attest
