#include "harness/port/builtin.hpp"

#include "controller/reference/unit.hpp"
#include "harness/port/abi_port.hpp"

namespace attest {

std::unique_ptr<Port> open_builtin() {
  return std::make_unique<AbiPort>(*reference::reference_unit());
}

}  // namespace attest
