#include "harness/trace/csv_text.hpp"

#include <algorithm>
#include <cstring>

namespace attest {

void CsvText::name(std::string_view text) {
  end_cell(begin_cell());
  append(text);
}

void CsvText::value_of(const Channel& channel, const Sample& sample) {
  switch (channel.type) {
    case ChannelType::f32:
      return number(float_of(channel, sample));
    case ChannelType::u64:
      return integer(integer_of(channel, sample));
    case ChannelType::u8:
    case ChannelType::bit:
      return integer(static_cast<std::uint64_t>(attest::value_of(channel, sample)));
  }
}

void CsvText::end_row() {
  append("\n");
  is_first_in_row_ = true;
}

Result<void> CsvText::finish() {
  flush();
  return status_;
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
  if (status_) status_ = write_(std::string_view(block_.data(), used_));
  used_ = 0;
}

}  // namespace attest
