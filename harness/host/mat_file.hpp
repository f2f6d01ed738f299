// Tables in MAT files. Only mat_file.cpp uses libmatio.
#pragma once

#include <filesystem>

#include "harness/core/result.hpp"
#include "harness/host/table.hpp"

namespace attest {

// Variables that are no vectors of real numbers are left out. Errors: no MAT file; those of
// check_mat_layout(); libmatio cannot be loaded. Threads: one at a time.
Result<Table> read_mat(const std::filesystem::path& path);

// MAT 5, not compressed. Writes a temporary file and renames it. Errors: the file cannot be
// written; libmatio cannot be loaded.
Result<void> write_mat(const std::filesystem::path& path, const Table& table);

}  // namespace attest
