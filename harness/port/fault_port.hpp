// `fault:ID` or `fault:ID+ID`: the reference with mistakes of the catalogue, to test a suite with.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "harness/port/port.hpp"

namespace attest {

// Errors: no such fault; says which is near.
Result<std::unique_ptr<Port>> open_fault(std::string_view ids);

}  // namespace attest
