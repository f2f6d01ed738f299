// Cases for a port with a fixed sample time (ATTEST_EXTENSION_FIXED_STEP).
//
// The law computes dt from timestamps. The first timestamp of a case is 5 s, and the law takes the
// previous one as 0. The law limits this dt of 5 s to 20 ms. A port with a fixed step uses its
// period instead, so it cannot agree. For such a port the cases begin one period after zero, so
// that each dt is the period. A golden has the outputs for its own timestamps. The expected outputs
// therefore come from the reference, after a check that the reference agrees with the golden.
//
// The units of the cascade compute dt from the times of their samples, so these must be one period
// apart too. A time of a topic that would be before zero, such as that of arming, becomes zero.
#pragma once

#include "harness/casefile/case.hpp"
#include "harness/host/port_says.hpp"
#include "harness/schedule/loop_timing.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// Whether `the_case` begins one period after zero for this port (Case::from_one_period_on). Mixers
// and battery estimates have no clock, so their cases are not shifted.
bool has_fixed_step(const PortSays& port, const Case& the_case);

// The inputs of a vector for this port: Case::from_one_period_on() if it has a fixed step.
Trace inputs_for(const PortSays& port, const Case& the_case, const Rate& rate);

// Whether the port has a fixed step that the case does not keep: another rate, ticks that are not
// exactly periodic, samples taken at other times, or a `start_s` of the case's own. In a flight of
// the cascade both units must keep the step. If the result is true, the verdict becomes
// unsupported, with the reason.
bool has_other_steps(const PortSays& port, const Case& the_case, const Rate& rate,
                     CaseResult& result);
bool has_other_steps(const PortSays& port, const Case& the_case, const Rate& rate,
                     const FlightTiming& timing, CaseResult& result);

// The same for a recorded trace, whose timestamps are fixed.
bool has_other_steps(const PortSays& port, const Trace& recorded, Module module,
                     CaseResult& result);

}  // namespace attest
