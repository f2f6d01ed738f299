// Reads [unit] of a case file: the timing of the unit's own ticks. In a flight of the cascade,
// [unit] is the rate unit and [attitude_unit] the other one.
#pragma once

#include "harness/casefile/case.hpp"
#include "harness/core/toml.hpp"

namespace attest {

// Returns the defaults if there is no table `name`. Errors are recorded in the table.
UnitTiming parse_unit(const TomlTable& root, const char* name = "unit");

// Checks jitter, stalls and dropped ticks against the slowest and the fastest rate and the
// duration. Errors are recorded in the table.
void check_unit(const TomlTable& root, const char* name, const UnitTiming& unit,
                const std::vector<Rate>& rates, const Span& duration);

}  // namespace attest
