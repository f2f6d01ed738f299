// Checks how deeply a TOML text is nested, before it is parsed.
#pragma once

#include <string>
#include <string_view>

#include "harness/core/result.hpp"

namespace attest {

// The limit for the parts of a key and for nested values; no file of attest reaches it. toml++
// limits nested values, but not the parts of a key. A key of 50,000 parts becomes 50,000 nested
// tables, and their recursive destruction overflows the stack.
inline constexpr int most_levels = 32;

// Errors: a dotted key or a table name with more than most_levels parts; arrays or inline tables
// nested more than most_levels deep. `name` stands for the file in messages. In text that is not
// valid TOML, the check is correct up to the first syntax error, where the parser stops.
Result<void> check_depth(std::string_view text, const std::string& name);

}  // namespace attest
