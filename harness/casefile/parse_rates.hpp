// Reads the loop rates of a case.
#pragma once

#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/core/toml.hpp"

namespace attest {

// Reads `rates_hz`, or returns the default rates of the case's module. In a flight of the cascade
// they are pairs such as "250:1000". Ascending. REQUIRES: the module of `parsed` is read. Errors
// are recorded in the table.
std::vector<LoopRate> parse_rates(const TomlTable& root, const Case& parsed);

// Reads a list of rates; of pairs if `is_cascade`. REQUIRES: the table has the key.
std::vector<LoopRate> parse_loop_rates(const TomlTable& table, const char* key, bool is_cascade);

}  // namespace attest
