// The golden of a flight, or of a long case, keeps some of its ticks: the keyframes. Thousands of
// goldens therefore fit into a repository. To compare every tick, the reference computes all ticks
// again, and its outputs at each keyframe must agree with the golden.
#pragma once

#include "harness/core/result.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// The keyframes of a trace, in order: the first ticks, ticks at regular distances, those where an
// output is smallest or largest, and the last; about forty in all. Parameters and in/updated bits
// are left out, because they describe changes since the previous tick, which may not be kept. The
// plant is left out, too. REQUIRES: not empty.
Trace keyframes_of(const Trace& flown);

// Returns `made`, which has the inputs of every tick, with the outputs of the reference. `kept`:
// the keyframes of the golden, with which these outputs must agree: to the bit, or at the numeric
// level if the bits depend on the platform (`is_exact` false). Errors: `kept` lacks an output, or
// has inputs that `made` does not have at that time; the reference of this build has other outputs.
Result<Trace> filled_in(Trace made, Trace kept, const Subject& subject, bool is_exact);

}  // namespace attest
