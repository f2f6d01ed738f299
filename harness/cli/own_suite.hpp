// Adds cases to the suite of a user.
#pragma once

#include <filesystem>
#include <string_view>

#include "harness/core/result.hpp"

namespace attest::cli {

// Makes `case_folder`, which is in `root`. A folder `root` that is not a suite becomes one whose
// base is the released suite.
Result<void> make_own_suite(const std::filesystem::path& root,
                            const std::filesystem::path& case_folder);

// Writes the text of a case to a new file. Errors: the file exists; the text has values that no
// case can have. In the second case the file is removed again.
Result<void> write_new_case(const std::filesystem::path& file, std::string_view toml);

}  // namespace attest::cli
