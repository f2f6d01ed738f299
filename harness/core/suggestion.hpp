// "did you mean ...?"
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace attest {

// "; did you mean `thrust`?", or empty when no candidate is near enough to be meant.
std::string suggestion(std::string_view unknown, const std::vector<std::string>& candidates);

}  // namespace attest
