// Two trace files beside each other, however long.
#pragma once

#include <filesystem>

#include "harness/compare/compare.hpp"

namespace attest {

// As compare(). CSV traces of a controller are read tick by tick, in memory that does not grow with
// them; at the events level, which looks ahead, and in other formats they are read whole. Errors:
// those of open_trace.
Result<Comparison> compare_files(const std::filesystem::path& got,
                                 const std::filesystem::path& want, const Tolerances& tolerances);

}  // namespace attest
