// The one exported symbol of the shared library of the references. The static library does not have
// it, so that a program can link the references together with another unit.
#include "controller/cascade/whole.hpp"

extern "C" const attest_unit* attest_unit_v1(void) { return attest::cascade::whole_reference(); }
