// Whether a port survives its first steps: before anything is compared.
#pragma once

#include <string>

#include "harness/host/port_process.hpp"

namespace attest {

inline constexpr std::size_t first_steps = 100;

// Lets the port control a level, armed vehicle for so many steps, at its fixed step or 250 Hz.
// Empty, or how it went wrong: "step at tick 3 returned ATTEST_FAILED".
std::string wrong_in_first_steps(const HostOptions& options, const std::string& profile);

}  // namespace attest
