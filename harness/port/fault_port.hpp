// `fault:ID` or `fault:ID+ID`: the reference with faults of the catalogue, to test a suite.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "controller/faults/fault.hpp"
#include "harness/port/port.hpp"

namespace attest {

// With `fraction_bits` the port declares fixed point, although it computes in floating point. This
// shows which faults pass with the tolerance for fixed point. Errors: no such fault, with the
// nearest known one.
Result<std::unique_ptr<Port>> open_fault(std::string_view ids,
                                         std::optional<int> fraction_bits = std::nullopt);

// The same of the catalogue's own faults.
std::unique_ptr<Port> open_faults(std::vector<const faults::Fault*> faults,
                                  std::optional<int> fraction_bits = std::nullopt);

}  // namespace attest
