// Traces and tables in MAT files (MATLAB, Octave, Simulink). Only mat_file.cpp uses libmatio.
#pragma once

#include <cstddef>
#include <filesystem>

#include "harness/core/file.hpp"
#include "harness/core/result.hpp"
#include "harness/host/table.hpp"

namespace attest {

// Version 5, 7 or 7.3, at most 1 GiB. Each vector of real numbers is a column, which has the
// variable's name; other variables are left out. All rows are read. Errors: no MAT file; columns of
// different lengths; no column; those of check_mat_layout(); libmatio cannot be loaded. Threads:
// one at a time.
Result<Table> read_mat(const std::filesystem::path& path, std::size_t most_rows);

// Writes a column vector for each column of the trace, its name an identifier (identifier_of()), in
// MAT 5, not compressed, and commits the file. Errors: the file cannot be written; libmatio cannot
// be loaded.
Result<void> write_mat(AtomicFile file, const Trace& trace);

}  // namespace attest
