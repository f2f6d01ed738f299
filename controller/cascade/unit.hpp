// The reference of the cascade behind the C ABI of attest_cascade.h.
#pragma once

#include "controller/attest_cascade.h"

namespace attest::cascade {

// A static table that has the attitude unit and the rate unit as extensions, and no controller of
// attest_unit.h; never NULL. Computes in binary32 unless compiled with
// ATTEST_REFERENCE_SCALAR=double.
const attest_unit* cascade_unit();

// The same law in binary64: a second correct cascade, to measure the effect of rounding.
const attest_unit* cascade_unit_in_double();

}  // namespace attest::cascade
