// The one exported symbol of the reference as a shared library. Not part of the static library,
// so that a program may link the reference next to another unit.
#include "controller/reference/unit.hpp"

extern "C" const attest_unit* attest_unit_v1(void) { return attest::reference::reference_unit(); }
