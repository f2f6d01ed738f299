// The golden of a flight, or of a long case, keeps some of its ticks, the keyframes, so that
// thousands of goldens fit into a repository. The reference fills in the others, once it has
// answered what the golden has at each keyframe.
#pragma once

#include "harness/core/result.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Of the controller. The first ticks, ticks at regular distances, those where an output is smallest
// and largest, and the last, in order; some forty in all. Without parameters, freshness and plant:
// what is left out between two keyframes cannot be replayed. REQUIRES: not empty.
Trace keyframes_of(const Trace& flown);

// `made` with the answers of the reference, which at the keyframes `kept` are those of the golden:
// to the bit, or where these are the platform's (`is_exact` false) at the numeric level. Errors:
// `kept` has inputs that `made` does not have at that time, or the reference of this build answers
// otherwise.
Result<Trace> filled_in(Trace made, const Trace& kept, const Subject& subject, bool is_exact);

}  // namespace attest
