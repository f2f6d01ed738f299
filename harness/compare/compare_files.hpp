// Compares two trace files of any length.
#pragma once

#include <filesystem>

#include "harness/compare/compare.hpp"

namespace attest {

// Same as compare(). Two CSV traces (csv.hpp) are read tick by tick, in memory that does not grow
// with their length. Otherwise both files are read whole; also at the events level, which looks
// ahead. Errors: those of open_trace; a file is a pipe.
Result<Comparison> compare_files(const std::filesystem::path& got,
                                 const std::filesystem::path& want, const Tolerances& tolerances);

}  // namespace attest
