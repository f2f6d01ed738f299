// Compares a flown trace with a golden that kept some of its ticks, up to a horizon. Two correct
// controllers differ in the last bits, and a flight amplifies that.
#pragma once

#include "harness/compare/compare.hpp"

namespace attest {

// Compares each row of `want` within `horizon_s` of the first with the tick of `got` at the same
// timestamp. Ticks in the result are those of `got`; `ticks` counts rows. Rows after the end of
// `got` are left out, because the caller reports that a flight ended. A row between two ticks is a
// mismatch.
Comparison compare_rows(const Trace& got, const Trace& want, double horizon_s,
                        const Tolerances& tolerances);

}  // namespace attest
