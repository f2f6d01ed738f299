// How much of a table of samples is in a file.
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
  std::uint64_t bytes = 0;  // of complete lines
  bool is_cut = false;      // an incomplete line follows
};

// A line that is not of the table: an error with its number, or the end of the table.
enum class WrongLine { is_error, ends_table };

// A file without a complete header is empty. Errors: unreadable.
Result<TableExtent> extent_of(
    const std::filesystem::path& file, const SampleColumns& columns, const SampleRange& range,
    WrongLine wrong, const OnRow& on_row = [](const SampleRow&) {});

// REQUIRES: a system call has just failed and set errno.
Error table_error(const std::filesystem::path& file, const std::string& what);

// The names of unfinished tables begin with this text: "samples.csv.part-".
std::string part_prefix(const std::filesystem::path& file);

// The unfinished tables of `file`, by the machines that make them.
std::vector<std::filesystem::path> parts_of(const std::filesystem::path& file);

}  // namespace attest
