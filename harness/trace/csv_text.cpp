#include "harness/trace/csv_text.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>

namespace attest {

void CsvText::name(std::string_view text) {
  begin_cell();
  append(text);
}

void CsvText::number(float value) {
  begin_cell();
  if (value != value) return append("nan");  // to_chars would tell the sign of a NaN
  char* const first = block_.data() + used_;
  used_ +=
      static_cast<std::size_t>(std::to_chars(first, first + longest_number, value).ptr - first);
}

void CsvText::integer(std::uint64_t value) {
  begin_cell();
  char* const first = block_.data() + used_;
  used_ +=
      static_cast<std::size_t>(std::to_chars(first, first + longest_number, value).ptr - first);
}

void CsvText::end_row() {
  append("\n");
  is_first_in_row_ = true;
}

Result<void> CsvText::finish() {
  flush();
  return status_;
}

void CsvText::begin_cell() {
  if (block_.size() - used_ < longest_number + 1) flush();
  if (!is_first_in_row_) block_[used_++] = ',';
  is_first_in_row_ = false;
}

void CsvText::append(std::string_view text) {
  while (!text.empty()) {
    if (used_ == block_.size()) flush();
    const std::size_t count = std::min(text.size(), block_.size() - used_);
    std::memcpy(block_.data() + used_, text.data(), count);
    used_ += count;
    text.remove_prefix(count);
  }
}

void CsvText::flush() {
  if (status_) status_ = file_.write(std::string_view(block_.data(), used_));
  used_ = 0;
}

}  // namespace attest
