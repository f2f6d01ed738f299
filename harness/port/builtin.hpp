// `builtin`: the reference, linked into the program.
#pragma once

#include <memory>

#include "harness/port/port.hpp"

namespace attest {

std::unique_ptr<Port> open_builtin();

// The reference in double precision. Horizons of flights are measured with it.
std::unique_ptr<Port> open_builtin_in_double();

}  // namespace attest
