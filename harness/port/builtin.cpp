#include "harness/port/builtin.hpp"

#include "controller/cascade/whole.hpp"
#include "harness/port/abi_port.hpp"

namespace attest {

std::unique_ptr<Port> open_builtin() {
  return std::make_unique<AbiPort>(*cascade::whole_reference());
}

std::unique_ptr<Port> open_builtin_in_double() {
  return std::make_unique<AbiPort>(*cascade::whole_reference_in_double());
}

}  // namespace attest
