// The conformance statement of a run, as one line and as a badge.
#pragma once

#include <string>
#include <vector>

#include "harness/verify/run_result.hpp"

namespace attest {

// The claim for each profile, or the reason why there is no claim. `subject`: suite, port and date;
// empty if there is no claim.
struct Statement {
  std::vector<std::string> claims;
  std::string subject;
};
Statement statement_of(const RunResult& run);

// The statement as one line: the claim for each profile, then suite, port and date:
//
//     conformant: px4-v1.5.5, numeric, 11 rates, all groups; cases 1.4, golden 1.4 (released suite
//     a8370e8fe0dc), port 5f1d2c3b4a59, 2026-03-31
//     partial: px4-v1.5.5, numeric, 1 rate, group tpa (because: only --rate 250; ...); ...
//     events agree: px4-v1.5.5, events, 11 rates, all groups; ...
//     none: px4-v1.5.5, 3 groups fail (attitude, modes, tpa); ...
std::string conformance_statement(const RunResult& run);

// A badge as the text of an SVG file: green if the port conforms to a profile, amber with the word
// "partial" if it passes in part, amber with "events agree" if it passes at the level events, else
// red.
std::string badge(const RunResult& run);

}  // namespace attest
