// Topics that a port never publishes. That is one mistake, so it makes one vector fail, and the
// other outputs of all vectors are judged.
#pragma once

#include <vector>

#include "harness/compare/compare.hpp"
#include "harness/port/lacks.hpp"
#include "harness/trace/trace.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// The outputs of the topics that `want` publishes and `got` does not, at no tick. Empty if `got`
// publishes none of the topics that `want` does. Stores which topics `got` publishes, and which it
// does not, in the result. `lacks`: outputs that are not judged.
ChannelSet silent_outputs(const Trace& got, const Trace& want, const ChannelSet& lacks,
                          VectorResult& result);

// All outputs of the topics that are silent in a result.
ChannelSet silent_outputs(const std::vector<VectorResult>& results);

// Removes the silent topics from the channels of a flown trace. Errors: the reference fails.
Result<void> leave_out_silent(const Lacks& lacks, Trace& flown, VectorResult& result);

// Decides about silent topics when all vectors were judged. A topic that the port published in no
// vector: the first vector that lacks it fails. Otherwise all vectors that lack it fail.
void settle_silent_topics(std::vector<VectorResult>& results);

}  // namespace attest
