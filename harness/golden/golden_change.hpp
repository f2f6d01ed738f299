// What blessing a case would change in its golden.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/golden/golden.hpp"

namespace attest {

// One line: how many traces, ticks and channels differ from `traces`, and the largest deviation;
// values differ as at the exact level. Empty when the golden is what would be written now.
std::string change_of_golden(const Case& the_case, const std::vector<GoldenTrace>& traces,
                             const std::filesystem::path& golden_root);

}  // namespace attest
