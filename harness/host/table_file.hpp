// Tables in files of two formats: CSV and MAT (MATLAB, Octave, Simulink).
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/host/table.hpp"

namespace attest {

enum class TableFormat { csv, mat };
inline constexpr std::array table_formats{TableFormat::csv, TableFormat::mat};
std::string_view name_of(TableFormat format);  // "csv", also the extension of its files
Result<TableFormat> parse_table_format(std::string_view name);

// CSV: numbers in decimal. A column may have no name.
// MAT: version 5, 7 or 7.3. Each vector of numbers is a column; the column has the variable's name.
// Of a CSV file, at most `most_rows` rows are read, so that the rows that no caller needs do not
// fill the memory; a MAT file is limited to 1 GiB. Errors: the file cannot be read; columns of
// different lengths; no column; those of the format, such as a CSV cell that is no number.
Result<Table> read_table(const std::filesystem::path& path, TableFormat format,
                         std::size_t most_rows = std::numeric_limits<std::size_t>::max());

// The inputs of a trace. MAT: a column vector for each, its name an identifier (identifier_of()).
// Errors: the file cannot be written.
Result<void> write_inputs(const std::filesystem::path& path, TableFormat format,
                          const Trace& trace);

}  // namespace attest
