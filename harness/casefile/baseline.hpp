// The values of the inputs that a case leaves out: a vehicle that hovers level and armed.
#pragma once

#include <optional>

#include "harness/trace/channels.hpp"

namespace attest {

// REQUIRES: an input.
double baseline(const Channel& channel);

// The baseline in a flight: the vehicle was armed 5 s before time 0, so its motors have spooled up.
double baseline_in_flight(const Channel& channel);

// The baseline of a thrust or throttle stick in a flight, in units of the vehicle's hover thrust.
// Empty for other channels.
std::optional<double> baseline_of_hover(const Channel& channel);

// All inputs of the module, without updated bits.
Sample baseline_sample(Module module);

}  // namespace attest
