// Two usual tests of a port, with which attest's suite is compared: a hover, and random pairs of
// attitude and setpoint. A port is caught if it has a fault, or if an output differs from the
// reference's.
#pragma once

#include <string>

#include "harness/port/port.hpp"

namespace attest {

// 10 s of hover at 250 Hz with a constant setpoint and default parameters. All outputs are compared
// numerically, in a profile of the cascade those of both units.
bool caught_by_hover(Port& port, const std::string& profile);

// 1000 pairs of any two attitudes, one step each. The rates setpoints are compared numerically, in
// a profile of the cascade those of the attitude unit.
bool caught_by_random_attitudes(Port& port, const std::string& profile);

}  // namespace attest
