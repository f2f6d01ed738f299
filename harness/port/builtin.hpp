// `builtin`: the reference, linked into the program.
#pragma once

#include <memory>

#include "harness/port/port.hpp"

namespace attest {

std::unique_ptr<Port> open_builtin();

}  // namespace attest
