// The results of a run by group and rate, as tables for the terminal and the HTML page.
#pragma once

#include <vector>

#include "harness/report/document.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

// A table for each profile; profiles with a failure come first. It has a row for each group, and a
// last row with the sums; a column for each rate at which the profile has results, ascending, and a
// last column with the sums. A cell has the number of vectors that passed:
//
//     px4-v1.5.5: vectors by group and rate [Hz]
//       group       100    250  1000/3    total
//       attitude     12  10/12       -    22/24
//       mixed       5+1      6       6     17+1
//       total      17+1  16/18       6  39/42+1
//
// "10/12": two of twelve failed; "5+1": one more was counted apart (unsupported, skip, xfail); "-":
// no result. The verdict of a cell is the gravest one; vectors that were not judged count less than
// those that passed. `small` is the smallest headroom, as in "3.1×"; empty: no passed vector
// differs in bits.
std::vector<DocumentTable> matrices_of(const RunResult& run);

}  // namespace attest
