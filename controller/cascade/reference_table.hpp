// The references' tables of functions, in a precision of choice.
#pragma once

#include "controller/attest_cascade.h"
#include "controller/cascade/unit_table.hpp"
#include "controller/reference_build.hpp"

namespace attest::cascade {

template <typename Scalar>
inline constexpr attest_unit reference_table{ATTEST_UNIT_ABI_VERSION,
                                             "attest-cascade",
                                             ATTEST_REFERENCE_VERSION,
                                             nullptr,
                                             nullptr,
                                             nullptr,
                                             nullptr,
                                             extension<Scalar>};

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

}  // namespace attest::cascade
