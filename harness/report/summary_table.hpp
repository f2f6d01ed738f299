// The table of a summary: a row per group, a column per rate.
//
//     group \ Hz   100    250  1000/3  total
//     attitude      12  10/12       -  22/24
//     mixed        5+1      6       6   17+1
//     total       17+1  16/18       6  39/41+1
//     n/m: n of m vectors passed; +k: k counted apart
//
// A cell is the number of vectors that passed; "10/12" when two of twelve failed; "5+1" with one
// that was counted apart (unsupported, skip, xfail); "-" without a result.
#pragma once

#include <string>

#include "harness/report/terminal.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

// Broken into several blocks of columns when it is wider than the style allows. Rows are prefixed
// by the profile when there are several. Empty when there are no results.
std::string render_table(const RunResult& run, TerminalStyle style);

}  // namespace attest
