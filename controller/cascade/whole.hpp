// The references of all modules as one port: the controller of v1.5.5 and v1.3.4, mixer, battery
// estimate, and the two units of the cascade.
#pragma once

#include "controller/attest_unit.h"

namespace attest::cascade {

// A static table; never NULL. Computes in binary32 unless compiled with
// ATTEST_REFERENCE_SCALAR=double.
const attest_unit* whole_reference();

// The same in binary64: a second correct port, to measure the effect of rounding.
const attest_unit* whole_reference_in_double();

}  // namespace attest::cascade
