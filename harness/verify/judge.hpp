// From the outputs or the fault of a port to a verdict: shared by open loop and flight.
#pragma once

#include <optional>

#include "harness/casefile/case.hpp"
#include "harness/compare/compare.hpp"
#include "harness/host/port_says.hpp"
#include "harness/loop/unit_driver.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// The tolerances of the level, or the case's own where it has some. For a port in fixed point they
// are at least its LSBs for a run of `ticks` ticks.
Tolerances tolerances_of(const Case& the_case, Level level, std::optional<int> fraction_bits,
                         std::size_t ticks);

// Whether the port declares that it does not support the result's group, or is recorded and the
// result is of a flight. If so, the verdict becomes unsupported, or skip.
bool declines(const PortSays& port, CaseResult& result);
bool declines(const PortSays& port, const std::string& group);

void judge(const PortFault& fault, CaseResult& result);

// Whether there are ticks before an ATTEST_UNSUPPORTED. They are judged, because a later
// ATTEST_UNSUPPORTED does not excuse wrong outputs.
bool leaves_ticks_to_judge(const PortFault& fault);

// From `tick` on, `answered` gets the outputs of `want`, so that only the ticks before it decide.
void leave_out_from(std::size_t tick, const Trace& want, Trace& answered);

// Copies the outputs `not_recorded` from `want` to `answered`, so that they are not judged. If a
// copied `published` is 0 at a tick, the other values of that topic are not judged there either.
void fill_in(const ChannelSet& not_recorded, const Trace& want, Trace& answered);

// Whether a recording without the outputs `not_recorded` leaves a value to compare with `want`: a
// recorded output other than a `published`. If the `published` of its topic is not recorded, `want`
// must publish that topic at a tick.
bool leaves_values_to_judge(const ChannelSet& not_recorded, const Trace& want);

// Adds to the reason the mistake of the recording that would give these outputs (misrecording.hpp).
void explain_recording(const Trace& answered, const Trace& want, CaseResult& result);

// Call after the ticks before the fault have been judged. A failure stays a failure; its reason
// then names the fault too.
void judge_after(const PortFault& fault, CaseResult& result);

void judge(const Comparison& comparison, CaseResult& result);

}  // namespace attest
