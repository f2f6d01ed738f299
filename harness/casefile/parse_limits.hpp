// The limits on how often something happens in a whole case.
#pragma once

#include "harness/casefile/case.hpp"
#include "harness/core/toml.hpp"

namespace attest {

// About twice the ticks of a minute at 8 kHz. A trace of a million samples fits in memory.
inline constexpr std::int64_t max_ticks = 1'000'000;

// Records an error for each of these that has more than max_ticks entries in memory: the steps of a
// random walk, the releases of a topic with jitter or drops, the runs of a flight's task. REQUIRES:
// the duration is valid.
void check_limits(const TomlTable& root, const Case& parsed);

}  // namespace attest
