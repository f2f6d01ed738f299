// The golden of a flight, or of a long case, keeps some of its ticks: the keyframes. Thousands of
// goldens therefore fit into a repository. The reference computes the other ticks, after a check
// that its outputs at each keyframe agree with the golden.
#pragma once

#include "harness/core/result.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// The keyframes of a trace of the controller, in order: the first ticks, ticks at regular
// distances, those where an output is smallest or largest, and the last; some forty in all.
// Parameters, freshness and plant are left out, because the ticks between two keyframes cannot be
// replayed. REQUIRES: not empty.
Trace keyframes_of(const Trace& flown);

// `made` with the outputs of the reference. At the keyframes `kept` these agree with the golden: to
// the bit, or at the numeric level if the bits depend on the platform (`is_exact` false). Errors:
// `kept` has inputs that `made` does not have at that time; the reference of this build has other
// outputs.
Result<Trace> filled_in(Trace made, Trace kept, const Subject& subject, bool is_exact);

}  // namespace attest
