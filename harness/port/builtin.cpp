#include "harness/port/builtin.hpp"

#include "controller/reference/unit.hpp"
#include "harness/port/abi_port.hpp"

namespace attest {

std::unique_ptr<Port> open_builtin() {
  return std::make_unique<AbiPort>(*reference::reference_unit());
}

std::unique_ptr<Port> open_builtin_in_double() {
  return std::make_unique<AbiPort>(*reference::reference_unit_in_double());
}

}  // namespace attest
