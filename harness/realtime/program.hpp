// Programs that others keep, used where they are installed.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace attest {

// In the folders of PATH.
bool is_installed(const std::string& program);

// Runs it to its end without input; what it printed on stdout, or nothing if it failed.
std::optional<std::string> output_of(const std::vector<std::string>& command);

}  // namespace attest
