// One case at one rate, or one recorded trace, for a port that is loaded in this process: the
// verdict. Nothing here guards against a port that crashes or hangs; worker.hpp does.
#pragma once

#include <filesystem>
#include <string>

#include "harness/casefile/case.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/port/port.hpp"
#include "harness/run/golden.hpp"
#include "harness/suite/verdict.hpp"

namespace attest {

// The identity of a result, before there is a verdict.
CaseResult unjudged(const Case& the_case, const Rate& rate);
CaseResult unjudged(const Trace& recorded, const std::string& profile);

// The case's inputs at that rate are made anew, given to a fresh unit, and what it answers is
// compared with the golden. Errors are the environment's: a golden that is missing or stale.
Result<CaseResult> evaluate_case(const Case& the_case, const Rate& rate, const Golden& golden,
                                 Port& port, Level level);

// The recorded inputs are given to a fresh unit, and what it answers is compared with the recorded
// outputs.
CaseResult evaluate_trace(const Trace& recorded, const std::string& profile, Port& port,
                          const Tolerances& tolerances);

}  // namespace attest
