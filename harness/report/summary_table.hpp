// The table of a summary: a row per group, a column per rate.
//
//     group \ Hz   100    250  1000/3  total
//     attitude      12  10/12       -  22/24
//     mixed        5+1      6       6   17+1
//     total       17+1  16/18       6  39/41+1
//     n/m: n of m vectors passed; +k: k counted apart
//
// A cell is the number of vectors that passed. "10/12": two of twelve failed; "5+1": one more was
// counted apart (unsupported, skip, xfail); "-": no result.
#pragma once

#include <string>

#include "harness/report/terminal.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

// A table wider than `style` allows is broken into several blocks of columns. If there are several
// profiles, the label of a row has the profile. Empty without results.
std::string render_table(const RunResult& run, TerminalStyle style);

}  // namespace attest
