// The reference of v1.5.5 and v1.3.4 behind the C ABI of attest_unit.h.
#pragma once

#include "controller/attest_unit.h"

namespace attest::mc_att_control {

// The static table of the reference; never NULL, outlives every instance. Computes in binary32
// unless compiled with ATTEST_REFERENCE_SCALAR=double.
const attest_unit* mc_att_control_unit();

// The same law in binary64: a second correct controller, to measure the effect of rounding.
const attest_unit* mc_att_control_unit_in_double();

}  // namespace attest::mc_att_control
