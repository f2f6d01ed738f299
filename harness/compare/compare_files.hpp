// Two trace files beside each other, however long.
#pragma once

#include <filesystem>

#include "harness/compare/compare.hpp"

namespace attest {

// As compare(), in memory that does not grow with the traces; but at the events level, which looks
// ahead and reads them whole. Errors: those of read_csv.
Result<Comparison> compare_files(const std::filesystem::path& got,
                                 const std::filesystem::path& want, const Tolerances& tolerances);

}  // namespace attest
