// Whether a port completes its first steps, before any comparison.
#pragma once

#include <string>

#include "harness/host/port_process.hpp"

namespace attest {

inline constexpr std::size_t first_steps = 100;

// Lets the port control a level, armed vehicle for `first_steps` steps, at its fixed step or 250
// Hz. Returns its fault, "step at tick 3 returned ATTEST_FAILED", or an empty string.
std::string wrong_in_first_steps(const HostOptions& options, const std::string& profile);

}  // namespace attest
