// Rows of numbers, streamed from a CSV file into structs.
//
//     auto rows = CsvRows::open(path);             // reads the header
//     rows->set_columns(...);                      // where each column of rows->header() goes
//     while (auto more = rows->next(&sample)) {    // ends at an Error
//       if (!*more) break;                         // end of file
//       ...
//     }
//
// The text takes a fixed amount of memory, independent of the length of the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/trace/csv_cells.hpp"

namespace attest {

// The size of a CSV file of which all rows are kept in memory. They take about 2.5 times as much.
inline constexpr std::uintmax_t most_csv_bytes = std::uintmax_t{4} << 30;

class CsvRows {
 public:
  // `unnamed`: whether one column may be without a name, as row numbers often are. Errors:
  // unreadable file, no header, a repeated column, a NUL byte in a name, a column without a name if
  // refused. `name`: the file in messages; if empty, `path`.
  enum class Unnamed { refused, allowed };
  static Result<CsvRows> open(const std::filesystem::path& path, Unnamed unnamed = Unnamed::refused,
                              std::string name = {});
  // The same for a file that was read before: `text` has its bytes, which are copied. A row whose
  // first cell is empty may then have more empty cells: each keeps the value of the row above, so
  // next() needs the same `row` again.
  static Result<CsvRows> of(std::string_view text, const std::filesystem::path& path);

  // For a caller that keeps all rows in memory. Errors: the file is larger than most_csv_bytes now,
  // and in next(), if it grows beyond.
  Result<void> limit_size();

  const std::string& file() const { return file_; }
  const std::vector<std::string>& header() const { return header_; }

  // REQUIRES: one for each name of header(), in the same order.
  void set_columns(std::vector<CsvColumn> columns) { columns_ = std::move(columns); }

  // Writes the next row's values to `row`. Returns false at the end of the file. Every NaN of type
  // f32 becomes the same quiet NaN. Errors: a cell that is not a value of its column's type, a
  // short or long row, an empty line before the last row, a line that is longer than 64 KiB.
  Result<bool> next(void* row);

  // About how many rows follow, if they are as long as the last one.
  std::size_t rows_left() const;

  // An error at the column's name in the header, or at its cell in the row last read.
  tl::unexpected<Error> fail_at_name(std::size_t column, std::string message) const;
  tl::unexpected<Error> fail_at_cell(std::size_t column, std::string message) const;

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  CsvRows() = default;
  Result<bool> next_line();
  Result<void> fill();
  tl::unexpected<Error> too_large() const;
  Result<void> read_header(Unnamed unnamed);
  bool parse_line(char* row) const;
  tl::unexpected<Error> diagnose(char* row) const;
  tl::unexpected<Error> fail_at_place(std::string_view place, std::string message) const;

  std::string file_;
  std::unique_ptr<std::FILE, Close> stream_;  // null: buffer_ has the whole text
  std::unique_ptr<char[]> buffer_;            // with room for a line end after the text
  std::size_t begin_ = 0;                     // of the unread text in buffer_
  std::size_t end_ = 0;
  bool at_end_of_file_ = false;
  bool empty_repeats_ = false;  // an empty cell has the value of the one above
  std::uintmax_t unread_ = 0;   // bytes of the file that are not yet in buffer_
  std::uintmax_t bytes_left_ = std::numeric_limits<std::uintmax_t>::max();

  std::string_view line_;  // the line last read, without its end
  int line_number_ = 0;
  std::vector<std::string> header_;
  std::vector<CsvColumn> columns_;
};

}  // namespace attest
