// The golden of a flight, or of a long case, keeps some of its ticks: the keyframes. Thousands of
// goldens therefore fit into a repository. To compare every tick, the reference computes all ticks
// again, and its outputs at each keyframe must agree with the golden.
#pragma once

#include <cstddef>
#include <vector>

#include "harness/trace/trace.hpp"

namespace attest {

// The keyframes of a trace, in order: the first ticks, ticks at regular distances, those where an
// output is smallest or largest, and the last; about forty in all. REQUIRES: not empty.
std::vector<std::size_t> keyframes_of(const Trace& trace);

}  // namespace attest
