// Writes CSV cell by cell into an AtomicFile or a string, in blocks.
#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "harness/core/file.hpp"
#include "harness/core/result.hpp"
#include "harness/trace/channels.hpp"

namespace attest {

class CsvText {
 public:
  // REQUIRES: `file` and `text` outlive this.
  explicit CsvText(AtomicFile& file)
      : write_([&file](std::string_view bytes) { return file.write(bytes); }) {}
  explicit CsvText(std::string& text)
      : write_([&text](std::string_view bytes) {
          text += bytes;
          return Result<void>();
        }) {}

  // A header cell. REQUIRES: no comma or line end in it.
  void name(std::string_view text);
  // The shortest decimal that reads back to the same bits; `nan` for every NaN.
  void number(float value);
  void number(double value);
  void integer(std::uint64_t value);
  void value_of(const Channel& channel, const Sample& sample);
  void end_row();

  // Writes the rest. Returns the first error of all writes.
  Result<void> finish();

 private:
  // Longer than any number: a double has up to 24 characters, a u64 has 20 digits.
  static constexpr std::size_t longest_number = 32;

  // Returns where the cell starts, with room for a number. The caller writes the cell and passes
  // its end to end_cell().
  char* begin_cell();
  template <typename Number>
  void finite_or_nan(Number value);
  void end_cell(const char* end) { used_ = static_cast<std::size_t>(end - block_.data()); }
  void append(std::string_view text);
  void flush();

  std::function<Result<void>(std::string_view)> write_;
  Result<void> status_;
  bool is_first_in_row_ = true;
  std::size_t used_ = 0;
  std::array<char, std::size_t{64} * 1024> block_;
};

// Inline, because they are called for every cell.

inline char* CsvText::begin_cell() {
  if (block_.size() - used_ < longest_number + 1) flush();
  char* at = block_.data() + used_;
  if (!is_first_in_row_) *at++ = ',';
  is_first_in_row_ = false;
  return at;
}

template <typename Number>
void CsvText::finite_or_nan(Number value) {
  char* const first = begin_cell();
  // to_chars would write the sign of a NaN.
  if (value != value) {
    end_cell(first);
    return append("nan");
  }
  end_cell(std::to_chars(first, first + longest_number, value).ptr);
}

inline void CsvText::number(float value) { finite_or_nan(value); }
inline void CsvText::number(double value) { finite_or_nan(value); }

inline void CsvText::integer(std::uint64_t value) {
  char* const first = begin_cell();
  end_cell(std::to_chars(first, first + longest_number, value).ptr);
}

}  // namespace attest
