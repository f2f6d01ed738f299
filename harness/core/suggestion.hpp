// Suggests the name that a misspelt one may stand for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace attest {

// "; did you mean `thrust`?"; empty when no candidate is near enough.
std::string suggestion(std::string_view unknown, const std::vector<std::string>& candidates);

}  // namespace attest
