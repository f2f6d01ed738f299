// Folders that a command makes for its user.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "harness/core/result.hpp"

namespace attest::cli {

// Makes the folder completely or not at all. `fill` fills it under a temporary name, and may throw
// std::filesystem::filesystem_error. Errors: the folder exists and is not empty; it cannot be made;
// those of `fill`.
Result<void> make_new_folder(const std::string& folder,
                             const std::function<Result<void>(const std::filesystem::path&)>& fill);

}  // namespace attest::cli
