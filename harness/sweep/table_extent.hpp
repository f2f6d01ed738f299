// Finds out how many rows of a table of samples are in a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/sweep/sample_table.hpp"

namespace attest {

struct TableExtent {
  std::uint64_t rows = 0;
  std::uint64_t bytes = 0;  // of the header and these rows
  bool is_cut = false;      // an incomplete line follows
};

// The effect of a line that is not of the table: an error with its number, or the end of the table.
enum class WrongLine { is_error, ends_table };

// A file without a complete header is empty. Errors: the file is unreadable; with
// WrongLine::is_error, a line is not of the table.
Result<TableExtent> extent_of(
    const std::filesystem::path& file, const SampleColumns& columns, const SampleRange& range,
    WrongLine wrong, const OnRow& on_row = [](const SampleRow&) {});

// `what`, with the text of errno. REQUIRES: a system call has just failed.
Error table_error(const std::filesystem::path& file, const std::string& what);

// The names of unfinished tables begin with this text: "samples.csv.part-".
std::string part_prefix(const std::filesystem::path& file);

// The unfinished tables of `file`, sorted by name.
std::vector<std::filesystem::path> parts_of(const std::filesystem::path& file);

}  // namespace attest
