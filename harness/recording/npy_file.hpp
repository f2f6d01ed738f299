// Tables in NPY files, the format of numpy.save(). Published as NEP 1 of numpy.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/recording/table.hpp"

namespace attest {

// A structured array of one dimension, or an array of two dimensions whose columns have the names
// `names`. Elements: integers, floats and booleans, little-endian. Errors: no NPY file; an
// incomplete one; another kind of array; no names; a number of columns that is not that of the
// names (a transposed array, for example).
Result<Table> read_npy(const std::filesystem::path& path, const std::vector<std::string>& names);

// A structured array. Writes a temporary file and renames it. Errors: the file cannot be written.
Result<void> write_npy(const std::filesystem::path& path, const Table& table);

}  // namespace attest
