// The limits that concern a whole case: how often something happens during it.
#pragma once

#include "harness/casefile/case.hpp"
#include "harness/core/toml.hpp"

namespace attest {

// About twice the ticks of a minute at 8 kHz. A trace of a million samples fits in memory.
inline constexpr std::int64_t max_ticks = 1'000'000;

// Records an error for each random walk with more than max_ticks steps, and for each topic or task
// of a flight with more than max_ticks irregular releases: the time of each of these is listed.
// REQUIRES: the duration is valid.
void check_limits(const TomlTable& root, const Case& parsed);

}  // namespace attest
