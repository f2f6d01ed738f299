// Groups of the results of a run, and their table by group and rate for the terminal and the page.
#pragma once

#include <algorithm>
#include <vector>

#include "harness/report/document.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

// Results that are shown together, in the order of the run.
using Together = std::vector<const VectorResult*>;

// Groups the results for which `wanted` is true. Two results for which `equal` is true are in the
// same group.
template <typename Wanted, typename Equal>
std::vector<Together> grouped(const RunResult& run, Wanted wanted, Equal equal) {
  std::vector<Together> groups;
  for (const VectorResult& result : run.results) {
    if (!wanted(result)) continue;
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const Together& known) {
      return equal(*known.front(), result);
    });
    if (group != groups.end())
      group->push_back(&result);
    else
      groups.push_back({&result});
  }
  return groups;
}

// A table for each profile of which a vector was judged; profiles with a failure come first. It has
// a row for each group, and a last row with the sums; a column for each rate at which the profile
// has results, ascending, and a last column with the sums. A cell has the number of vectors that
// passed:
//
//     px4-v1.5.5: vectors by group and rate [Hz]
//       group       100    250  1000/3    total
//       attitude     12  10/12       -    22/24
//       mixed       5+1      6       6     17+1
//       total      17+1  16/18       6  39/42+1
//
// "10/12": two of twelve failed; "5+1": one more was counted apart (unsupported, skip, xfail); "-":
// no result; "5*" and in the last column "17 STOPPED": the run ended before all its vectors were
// run, so the cell is not one of a pass. The verdict of a cell is the gravest one; vectors that
// were not judged count less than those that passed. `small` is the smallest headroom, as in
// "3.1×"; empty: no passed vector differs in bits.
std::vector<DocumentTable> matrices_of(const RunResult& run);

// The same for the whole run: a column for each profile, all its rates together.
DocumentTable matrix_by_profile(const RunResult& run);

}  // namespace attest
