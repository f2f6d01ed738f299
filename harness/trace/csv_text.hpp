// Writes CSV cell by cell into an AtomicFile, in blocks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "harness/core/file.hpp"
#include "harness/core/result.hpp"

namespace attest {

class CsvText {
 public:
  // REQUIRES: `file` outlives this.
  explicit CsvText(AtomicFile& file) : file_(file) {}

  // A header cell. REQUIRES: no comma or line end in it.
  void name(std::string_view text);
  // The shortest decimal that reads back to the same bits; `nan` for every NaN.
  void number(float value);
  void integer(std::uint64_t value);
  void end_row();

  // Writes what is left, and gives the first error of all that was written.
  Result<void> finish();

 private:
  // Longer than any number: 20 digits of a u64.
  static constexpr std::size_t longest_number = 32;

  void begin_cell();
  void append(std::string_view text);
  void flush();

  AtomicFile& file_;
  Result<void> status_;
  bool is_first_in_row_ = true;
  std::size_t used_ = 0;
  std::array<char, std::size_t{64} * 1024> block_;
};

}  // namespace attest
