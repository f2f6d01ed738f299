#include "controller/cascade/whole.hpp"

#include "controller/cascade/unit.hpp"
#include "controller/mc_att_control/unit.hpp"

namespace attest::cascade {
namespace {

// The controller's table, with the extensions of the controller and of the two units.
template <const attest_unit* (*controller)(), const attest_unit* (*units)()>
const attest_unit* whole() {
  static const attest_unit table = [] {
    attest_unit unit = *controller();
    unit.extension = [](const char* id) {
      const void* const found = controller()->extension(id);
      return found ? found : units()->extension(id);
    };
    return unit;
  }();
  return &table;
}

}  // namespace

const attest_unit* whole_reference() {
  return whole<mc_att_control::mc_att_control_unit, cascade_unit>();
}

const attest_unit* whole_reference_in_double() {
  return whole<mc_att_control::mc_att_control_unit_in_double, cascade_unit_in_double>();
}

}  // namespace attest::cascade
