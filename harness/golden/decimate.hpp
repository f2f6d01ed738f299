// The ticks of a flight, or of a long case, that its golden keeps, so that thousands fit into a
// repository.
#pragma once

#include "harness/trace/trace.hpp"

namespace attest {

// Of the controller. The first ticks, ticks at regular distances, those where an output is smallest
// and largest, and the last, in order; some forty in all. Without parameters, freshness and plant:
// what is left out between two rows cannot be replayed. REQUIRES: not empty.
Trace decimated(const Trace& flown);

}  // namespace attest
