// `fault:ID` or `fault:ID+ID`: the reference with mistakes of the catalogue, to test a suite with.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "harness/port/port.hpp"

namespace attest {

// With `fraction_bits` it says that it is in fixed point, which it is not: to see which mistakes
// the tolerance for such ports lets pass. Errors: no such fault; says which is near.
Result<std::unique_ptr<Port>> open_fault(std::string_view ids,
                                         std::optional<int> fraction_bits = std::nullopt);

}  // namespace attest
