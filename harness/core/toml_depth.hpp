// Checks how deeply a TOML text is nested, before it is parsed.
#pragma once

#include <string>
#include <string_view>

#include "harness/core/result.hpp"

namespace attest {

// The limit for the parts of a key and for nested values; no file of attest reaches it. toml++
// limits nested values only. A key of 50,000 parts becomes as many tables, and their recursive
// destruction overflows the stack.
inline constexpr int most_levels = 32;

// Errors: a dotted key or a table name with more than most_levels parts; values nested more deeply.
// `name` stands for the file in messages. Text that is not valid TOML is checked as far as the
// parser reads it.
Result<void> check_depth(std::string_view text, const std::string& name);

}  // namespace attest
