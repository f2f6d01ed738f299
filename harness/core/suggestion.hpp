// Suggests the name that a misspelt one may stand for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace attest {

// For example "; did you mean `thrust`?". Empty if no candidate is near enough, or if `unknown` is
// longer than 200 bytes.
std::string suggestion(std::string_view unknown, const std::vector<std::string>& candidates);

}  // namespace attest
