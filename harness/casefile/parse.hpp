// Reads case files. SCHEMA.md lists every key.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/core/result.hpp"

namespace attest {

// The version of the format of case files.
inline constexpr std::int64_t schema_version = 1;

// Reads cases/<profile>/<group>/<name>.toml as a case of the profile of its folder. Errors: the
// file cannot be read; syntax; unknown keys (with the nearest known one); values out of range;
// profiles without that of the folder; a group that differs from the folder's. All errors of the
// content are reported together, with file:line.
Result<Case> parse_case(const std::filesystem::path& file);
// The same for the text of a file, which need not exist.
Result<Case> parse_case_text(std::string_view text, const std::filesystem::path& file);

// Folders with case files. A file replaces the one with the same path below an earlier folder.
using CaseFolders = std::vector<std::filesystem::path>;

// The case files below the folders, in the order of their paths relative to their folder. Errors:
// no such folder, a folder without cases.
Result<std::vector<std::filesystem::path>> find_case_files(const CaseFolders& folders);

}  // namespace attest
