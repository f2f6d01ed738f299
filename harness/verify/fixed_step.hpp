// Cases for a port with a fixed sample time (ATTEST_EXTENSION_FIXED_STEP).
//
// The law computes dt from timestamps. By default the first timestamp of a case is 5 s, and the law
// starts with a previous timestamp of 0. It limits this dt of 5 s to 20 ms. A port with a fixed
// step uses its period at the first tick too, so its outputs would differ. For such a port the
// cases begin one period after zero, so that each dt is the period. The goldens are for other
// timestamps, so the expected outputs come from the reference, which must agree with the golden.
//
// The units of the cascade compute dt from the times of their samples, so the samples must be one
// period apart too. A time in a topic that would be before zero, such as that of arming, becomes
// zero.
#pragma once

#include "harness/casefile/case.hpp"
#include "harness/core/loop_timing.hpp"
#include "harness/host/declarations.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// Whether `the_case` must begin one period after zero for this port (Case::from_one_period_on).
// False for mixers and battery estimates, which have no clock.
bool has_fixed_step(const Declarations& port, const Case& the_case);

// The inputs of a vector for this port: of Case::from_one_period_on() if has_fixed_step().
// `parameters` replace those of the case, if its module and profile have them.
Trace inputs_for(const Declarations& port, const Case& the_case, const Rate& rate,
                 const std::vector<ParameterChange>& parameters = {});

// Whether the port has a fixed step that the case does not keep: another rate, ticks that are not
// exactly periodic, samples taken at other times, or a `start_s` of the case's own. If so, the
// verdict becomes unsupported, with the reason.
bool has_other_steps(const Declarations& port, const Case& the_case, const Rate& rate,
                     VectorResult& result);

// The same for a flight, whose ticks begin at the times of `timing`. In the cascade both units must
// keep the step. The times of the samples are not checked.
bool has_other_steps(const Declarations& port, const Case& the_case, const Rate& rate,
                     const FlightTiming& timing, VectorResult& result);

// The same for a recorded trace, or for a part of it that begins at `first_tick`: tick k and the
// sample of it must be at k + 1 periods.
bool has_other_steps(const Declarations& port, const Trace& recorded, Module module,
                     VectorResult& result, std::size_t first_tick = 0);

}  // namespace attest
