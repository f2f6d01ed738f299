// Reads the loop rates of a case.
#pragma once

#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/core/toml.hpp"

namespace attest {

// `rates_hz`, or the default rates of the case's module; of a flight of the cascade pairs such as
// "250:1000". Ascending. REQUIRES: `parsed` has its module. Errors are recorded in the table.
std::vector<LoopRate> parse_rates(const TomlTable& root, const Case& parsed);

// The same for any list of rates. REQUIRES: the table has the key.
std::vector<LoopRate> parse_loop_rates(const TomlTable& table, const char* key, bool is_cascade);

}  // namespace attest
