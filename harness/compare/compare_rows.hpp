// A flown trace beside a golden that kept some of its ticks: two right controllers part in the last
// bits, and a flight amplifies that, so it is compared up to a horizon only.
#pragma once

#include "harness/compare/compare.hpp"

namespace attest {

// Each row of `want` within `horizon_s` of the first with the tick of `got` at the same timestamp.
// Ticks in the result are those of `got`, `ticks` counts rows. Rows after the end of `got` are left
// out: that a flight ended is said otherwise. A row that falls between ticks is a mismatch.
Comparison compare_rows(const Trace& got, const Trace& want, double horizon_s,
                        const Tolerances& tolerances);

}  // namespace attest
