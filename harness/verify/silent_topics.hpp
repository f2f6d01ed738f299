// Topics that a port never publishes. That is one mistake, so it makes one vector fail, and the
// other outputs of all vectors are judged.
#pragma once

#include <functional>
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

// All outputs of the topics that no vector of a profile publishes.
ChannelSet never_published_outputs(const std::vector<VectorResult>& results);

// Removes the silent topics from the channels of a flown trace. Errors: the reference fails.
Result<void> leave_out_silent(const Lacks& lacks, Trace& flown, VectorResult& result);

// Decides about silent topics when all vectors were judged. If the port published the topic in no
// vector of the profile, the first vector that needs it fails. Otherwise each vector fails that
// needs it and lacks it. A vector whose failure `is_excused` fails in addition, so that an expected
// failure excuses no other vector.
void settle_silent_topics(
    std::vector<VectorResult>& results, const std::function<bool(const VectorResult&)>& is_excused =
                                            [](const VectorResult&) { return false; });

}  // namespace attest
