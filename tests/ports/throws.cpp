// SPDX-License-Identifier: BSD-3-Clause
// Judged: crash, with the text of the exception: an exception that leaves the C ABI is not caught.
#include <stdexcept>

#include <attest_unit.h>

extern "C" const attest_unit* attest_starter_unit_v1(void);

namespace {

int step(void*, const attest_inputs*, attest_outputs*) {
  throw std::runtime_error("gimbal lock in aisle 3");
}

}  // namespace

extern "C" const attest_unit* attest_unit_v1(void) {
  static const attest_unit unit = [] {
    attest_unit table = *attest_starter_unit_v1();
    table.name = "throws";
    table.step = step;
    return table;
  }();
  return &unit;
}
