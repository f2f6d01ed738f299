// Tables in files of three formats: CSV, MAT (MATLAB, Octave, Simulink) and NPY (numpy).
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/recording/table.hpp"

namespace attest {

enum class TableFormat { csv, mat, npy };
inline constexpr std::array table_formats{TableFormat::csv, TableFormat::mat, TableFormat::npy};
std::string_view name_of(TableFormat format);  // "csv", also the extension of its files
Result<TableFormat> parse_table_format(std::string_view name);

// CSV: numbers in decimal. A column may have no name.
// MAT: version 5, 7 or 7.3. Each vector of numbers is a column; the column has the variable's name.
// NPY: version 1 to 3. A structured array has names. In an array of two dimensions, rows are ticks,
// and `names` are those of its columns.
// Of a CSV file, at most `most_rows` rows are read, so that the rows that no caller needs do not
// fill the memory; the other formats are limited to 1 GiB. Errors: the file cannot be read; columns
// of different lengths; no column; those of the format, such as a CSV cell that is no number, or an
// NPY array of two dimensions whose number of columns is not that of `names`.
Result<Table> read_table(const std::filesystem::path& path, TableFormat format,
                         const std::vector<std::string>& names,
                         std::size_t most_rows = std::numeric_limits<std::size_t>::max());

// The inputs of a trace. MAT: a column vector for each, its name an identifier (identifier_of()).
// NPY: a structured array. Errors: the file cannot be written.
Result<void> write_inputs(const std::filesystem::path& path, TableFormat format,
                          const Trace& trace);

}  // namespace attest
