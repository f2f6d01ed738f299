// The two usual tests of a port: a recorded hover, and random pairs of attitude and setpoint. The
// suite is compared with them.
#pragma once

#include <string>

#include "harness/port/port.hpp"

namespace attest {

// 10 s of hover at 250 Hz with a quiet pilot, default parameters, outputs compared numerically.
bool caught_by_hover(Port& port, const std::string& profile);

// 1000 pairs of any two attitudes, one step each: the rates setpoints compared numerically.
bool caught_by_random_attitudes(Port& port, const std::string& profile);

}  // namespace attest
