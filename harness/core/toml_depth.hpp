// How deep the tables of a TOML text are, looked at before it is parsed.
#pragma once

#include <string>
#include <string_view>

#include "harness/core/result.hpp"

namespace attest {

// More than any file of attest has, of the parts of a key and of values in each other. toml++
// bounds nested values only: a key of 50,000 parts becomes as many tables, and destroying them
// recursively overflows the stack.
inline constexpr int most_levels = 32;

// Errors: a dotted key, or the name of a table, of more parts than that, or values nested more
// deeply; `name` stands for the file. Text that is not valid TOML is followed as far as the parser
// follows it.
Result<void> check_depth(std::string_view text, const std::string& name);

}  // namespace attest
