// Derives a verdict from the outputs or the fault of a port, in open loop and in flight.
#pragma once

#include <optional>

#include "harness/casefile/case.hpp"
#include "harness/compare/compare.hpp"
#include "harness/host/declarations.hpp"
#include "harness/loop/unit_driver.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// If the port declares that it does not support the result's group, the verdict becomes
// unsupported. If the port is recorded and the result is of a flight, the verdict becomes skip.
// Returns true in both cases.
bool marks_declined(const Declarations& port, VectorResult& result);
bool marks_declined(const Declarations& port, const std::string& group);

void judge(const PortFault& fault, VectorResult& result);

// Whether the fault is an ATTEST_UNSUPPORTED after the first tick. The ticks before it are judged,
// because a later ATTEST_UNSUPPORTED does not excuse wrong outputs.
bool leaves_ticks_to_judge(const PortFault& fault);

// From `tick` on, `answered` gets the outputs of `want`, so that only earlier ticks are judged.
void leave_out_from(std::size_t tick, const Trace& want, Trace& answered);

// Copies the outputs `not_judged` from `want` to `answered`, so that they are not judged. If
// `answered` then does not publish a topic at a tick, the topic keeps the values last published.
void fill_in(const ChannelSet& not_judged, const Trace& want, Trace& answered);

// Whether a comparison with `want` without the outputs `not_judged` leaves a value that is not 0 at
// all ticks: an output other than a `published`. If the `published` of its topic is not judged,
// `want` must publish that topic at a tick.
bool leaves_values_to_judge(const ChannelSet& not_judged, const Trace& want);

// Adds to the reason the mistake of the recording that would give these outputs (misrecording.hpp).
void explain_recording(const Trace& answered, const Trace& want, VectorResult& result);

// Adds a fault to a result for which the ticks before the fault have been judged. A pass gets the
// verdict of the fault. Any other verdict stays, and its reason then names the fault too.
void judge_after(const PortFault& fault, VectorResult& result);

void judge(const Comparison& comparison, VectorResult& result);

}  // namespace attest
