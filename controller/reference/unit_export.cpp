// The one exported symbol of the reference as a shared library. The static library leaves it out,
// so that a program can link the reference together with another unit.
#include "controller/reference/unit.hpp"

extern "C" const attest_unit* attest_unit_v1(void) { return attest::reference::reference_unit(); }
