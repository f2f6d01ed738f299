// Compares two trace files of any length.
#pragma once

#include <filesystem>

#include "harness/compare/compare.hpp"

namespace attest {

// Same as compare(). The files are read tick by tick, in memory that does not grow with their
// length; whole at the events level, which looks ahead. Errors: those of read_csv(); a file is a
// pipe.
Result<Comparison> compare_files(const std::filesystem::path& got,
                                 const std::filesystem::path& want, const Tolerances& tolerances);

}  // namespace attest
