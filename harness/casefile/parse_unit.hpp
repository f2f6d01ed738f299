// Reads [unit] of a case file: the timing of the unit's own ticks.
#pragma once

#include "harness/casefile/case.hpp"
#include "harness/core/toml.hpp"

namespace attest {

// Returns the defaults where there is no [unit]. Errors are recorded in the table.
UnitTiming parse_unit(const TomlTable& root);

// Checks jitter, stalls and dropped ticks against the rates and the duration. REQUIRES: `parsed`
// has both. Errors are recorded in the table.
void check_unit(const TomlTable& root, const Case& parsed);

}  // namespace attest
