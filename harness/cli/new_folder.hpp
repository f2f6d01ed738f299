// Folders that a command makes for its user.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "harness/core/result.hpp"

namespace attest::cli {

// Makes a folder that is complete or missing: `fill` fills it under another name, and may throw
// fs::filesystem_error. Errors: it exists and is not empty; it cannot be made; those of `fill`.
Result<void> make_new_folder(const std::string& folder,
                             const std::function<Result<void>(const std::filesystem::path&)>& fill);

}  // namespace attest::cli
