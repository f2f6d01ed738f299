// Compares a flown trace with a golden that kept some of its ticks, up to a horizon. Beyond it two
// correct controllers may differ, because a flight amplifies differences in the last bits.
#pragma once

#include "harness/compare/compare.hpp"

namespace attest {

// Compares each row of `want` that is at most `horizon_s` after its first row with the tick of
// `got` at the same timestamp. Ticks in the result are those of `got`; Comparison::ticks counts
// rows. Rows after the end of `got` are left out, because the caller reports that a flight ended.
// If `got` has no tick at the time of a row, this is a mismatch.
Comparison compare_rows(const Trace& got, const Trace& want, double horizon_s,
                        const Tolerances& tolerances);

}  // namespace attest
