// The limits on how often something happens in a whole case.
#pragma once

#include "harness/casefile/case.hpp"
#include "harness/core/toml.hpp"

namespace attest {

// About twice the ticks of a minute at 8 kHz. A trace of a million samples fits in memory.
inline constexpr std::int64_t max_ticks = 1'000'000;

// Errors, with the case's file: it has more than `most` ticks. For a rate that the case file does
// not have; parse_case() checks the rates that it has.
Result<void> check_ticks(const Case& the_case, const LoopRate& rate, std::int64_t most = max_ticks);

// Records an error for each of these that has more than max_ticks entries in memory: the steps of a
// random walk, the releases of a topic with jitter or drops, the runs of a flight's task. REQUIRES:
// the duration is valid.
void check_limits(const TomlTable& root, const Case& parsed);

}  // namespace attest
