// Reads [unit] of a case file: when the unit's own ticks happen.
#pragma once

#include "harness/casefile/case.hpp"
#include "harness/core/toml.hpp"

namespace attest {

// The defaults where there is no [unit]. Errors are noted in the table.
UnitTiming parse_unit(const TomlTable& root);

// What jitter, stalls and dropped ticks may be depends on the rates and the duration, which
// `parsed` has by now. Errors are noted in the table.
void check_unit(const TomlTable& root, const Case& parsed);

}  // namespace attest
