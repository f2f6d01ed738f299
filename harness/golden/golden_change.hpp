// What blessing a case would change in its golden.
#pragma once

#include <filesystem>
#include <string>

#include "harness/golden/make_golden.hpp"

namespace attest {

// One line: how many traces, ticks and channels differ from `made`, and the largest deviation,
// where values differ as at the exact level; or that only the case, the vehicle's files, metrics or
// horizons did. Empty when the golden is what would be written now.
std::string change_of_golden(const Case& the_case, const MadeGolden& made,
                             const std::filesystem::path& golden_root);

}  // namespace attest
