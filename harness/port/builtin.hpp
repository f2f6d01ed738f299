// `builtin`: the reference, linked into the program.
#pragma once

#include <memory>

#include "harness/port/port.hpp"

namespace attest {

std::unique_ptr<Port> open_builtin();

// The reference in double precision. It serves to measure the horizon of a flight: the time up to
// which the flight is compared with its golden (docs/flights.md).
std::unique_ptr<Port> open_builtin_in_double();

}  // namespace attest
