#include "harness/port/builtin.hpp"

#include "controller/cascade/unit.hpp"
#include "controller/reference/unit.hpp"
#include "harness/port/abi_port.hpp"

namespace attest {
namespace {

// The references of all modules as one port.
template <const attest_unit* (*controller)(), const attest_unit* (*cascade)()>
const attest_unit& whole() {
  static const attest_unit table = [] {
    attest_unit unit = *controller();
    unit.extension = [](const char* id) {
      const void* const found = controller()->extension(id);
      return found ? found : cascade()->extension(id);
    };
    return unit;
  }();
  return table;
}

}  // namespace

std::unique_ptr<Port> open_builtin() {
  return std::make_unique<AbiPort>(whole<reference::reference_unit, cascade::cascade_unit>());
}

std::unique_ptr<Port> open_builtin_in_double() {
  return std::make_unique<AbiPort>(
      whole<reference::reference_unit_in_double, cascade::cascade_unit_in_double>());
}

}  // namespace attest
