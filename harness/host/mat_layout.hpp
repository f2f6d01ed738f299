// The layout of a MAT file. libmatio does not check it: where a variable has fewer values than its
// dimensions say, libmatio returns zeros or other bytes in their place.
#pragma once

#include <filesystem>

#include "harness/core/result.hpp"

namespace attest {

// Checks files of the formats 5 to 7, whose variables may be compressed. Format 7.3 is HDF5, which
// checks itself; format 4 is not checked. Errors, with the file and the variable: a number of
// values that is not that of the dimensions; a compressed variable that cannot be decompressed.
// Errors, with the file: it cannot be read, or ends inside a variable.
Result<void> check_mat_layout(const std::filesystem::path& path);

}  // namespace attest
