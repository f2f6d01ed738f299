// A golden of a long case keeps some of its ticks. The reference fills in the others, once it has
// answered what the golden has at each tick that was kept.
#pragma once

#include "harness/core/result.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// `made` with the answers of the reference, which at the ticks of `kept` are those of the golden:
// to the bit, or where these are the platform's (`is_exact` false) at the numeric level. Errors:
// `kept` has inputs that `made` does not have at that time, or the reference of this build answers
// otherwise.
Result<Trace> filled_in(Trace made, const Trace& kept, const Subject& subject, bool is_exact);

}  // namespace attest
