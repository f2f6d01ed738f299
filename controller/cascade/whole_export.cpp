// The one exported symbol of the references as a shared library. The static library leaves it out,
// so that a program can link the references together with another unit.
#include "controller/cascade/whole.hpp"

extern "C" const attest_unit* attest_unit_v1(void) { return attest::cascade::whole_reference(); }
