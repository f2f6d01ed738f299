// Cases for a port that knows only its own sample time (ATTEST_EXTENSION_FIXED_STEP).
//
// The law takes its dt from timestamps. That of a case's first tick is 5 s, and `last` is 0 before
// it: the first dt saturates at 20 ms, which a constant dt does not. The cases of such a port
// therefore begin one period after zero, so that each dt is the period. A golden has the outputs
// for its own timestamps, so the reference makes those to compare with, after it was seen to agree
// with the golden.
#pragma once

#include "harness/casefile/case.hpp"
#include "harness/host/port_says.hpp"
#include "harness/schedule/loop_timing.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// Whether the port is given `the_case` from one period after zero on (Case). Mixers and battery
// estimates have no clock, so theirs are left as they are.
bool has_fixed_step(const PortSays& port, const Case& the_case);

// The port has a fixed step, and the case has another somewhere: the verdict is unsupported, with
// the reason. Another rate, ticks that are not exactly periodic, a `start_s` of the case's own.
bool has_other_steps(const PortSays& port, const Case& the_case, const Rate& rate,
                     CaseResult& result);
bool has_other_steps(const PortSays& port, const Case& the_case, const Rate& rate,
                     const LoopTiming& timing, CaseResult& result);

// The same for a recorded trace, whose timestamps are what they are.
bool has_other_steps(const PortSays& port, const Trace& recorded, CaseResult& result);

}  // namespace attest
