// Cells of a CSV file: converts text to a value of the column's type, and reports errors.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>

#include "harness/trace/channels.hpp"

namespace attest {

// text: a std::string_view of the cell, valid until the next row is read. ignored: any text.
enum class CellType : std::uint8_t { u64, f32, u8, bit, f64, text, ignored };

inline CellType cell_type(ChannelType type) {
  switch (type) {
    case ChannelType::u64:
      return CellType::u64;
    case ChannelType::f32:
      return CellType::f32;
    case ChannelType::u8:
      return CellType::u8;
    case ChannelType::bit:
      return CellType::bit;
  }
  return CellType::ignored;
}

// Parses the rare floats: those with a plus sign, and those too small for 32 bits, which become
// zero. Returns the end of the number. Returns null if [first, last) does not begin with a number,
// or if that number is too large for 32 bits.
const char* parse_unusual_float(const char* first, const char* last, float& value);

// For example "`1.2.3` is not a number for in/battery_status.scale; write a decimal number, ...".
// REQUIRES: `cell` is not a value of that type.
std::string cell_error(std::string_view cell, CellType type, std::string_view column);

// Prepares a text for a message: shortens it, applies printable_part(), and adds backquotes.
std::string in_backquotes(std::string_view text);

// The parsers below read a value at `first`, store it at `to`, and return its end, or null if there
// is no value. REQUIRES: *last is readable and not a digit. They are in the header to be inlined:
// half of the cells of a trace are flags of one digit, for which a call costs more than the work.

// The type of a column's cells and where they are stored.
struct CsvColumn {
  CellType type;
  std::size_t offset;     // of the member in the row's struct [bytes]
  std::uint32_t bit = 0;  // mask, for CellType::bit
};

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

inline bool is_single_digit(const char* first, const char* last) {
  return is_digit(*first) && (first + 1 == last || first[1] == ',');
}

inline const char* parse_float(const char* first, const char* last, void* to) {
  float value = 0;
  const char* end = first + 1;
  if (is_single_digit(first, last)) {
    value = static_cast<float>(*first - '0');
  } else {
    const auto parsed = std::from_chars(first, last, value);
    end = parsed.ec == std::errc() ? parsed.ptr : parse_unusual_float(first, last, value);
    if (value != value) value = std::numeric_limits<float>::quiet_NaN();  // without sign
  }
  std::memcpy(to, &value, sizeof value);
  return end;
}

inline const char* parse_double(const char* first, const char* last, void* to) {
  if (first != last && *first == '+') ++first;
  double value = 0;
  const auto parsed = std::from_chars(first, last, value);
  std::memcpy(to, &value, sizeof value);
  return parsed.ec == std::errc() ? parsed.ptr : nullptr;
}

inline const char* parse_byte(const char* first, const char* last, void* to) {
  std::uint8_t value = 0;
  const char* end = first + 1;
  if (is_single_digit(first, last)) {
    value = static_cast<std::uint8_t>(*first - '0');
  } else {
    const auto parsed = std::from_chars(first, last, value);
    end = parsed.ec == std::errc() ? parsed.ptr : nullptr;
  }
  std::memcpy(to, &value, sizeof value);
  return end;
}

inline const char* parse_bit(const char* first, const char* last, std::uint32_t bit, void* to) {
  if (!is_single_digit(first, last) || *first > '1') return nullptr;
  std::uint32_t word = 0;
  std::memcpy(&word, to, sizeof word);
  word = *first == '1' ? word | bit : word & ~bit;
  std::memcpy(to, &word, sizeof word);
  return first + 1;
}

inline const char* parse_integer(const char* first, const char* last, void* to) {
  std::uint64_t value = 0;
  const auto parsed = std::from_chars(first, last, value);
  std::memcpy(to, &value, sizeof value);
  return parsed.ec == std::errc() ? parsed.ptr : nullptr;
}

inline const char* parse_text(const char* first, const char* last, void* to) {
  const char* const end = std::find(first, last, ',');
  const std::string_view value(first, static_cast<std::size_t>(end - first));
  std::memcpy(to, &value, sizeof value);
  return end;
}

// Inlining is forced, because clang would otherwise call the function: 5% of the reading time.
[[gnu::always_inline]] inline const char* parse_cell(const char* first, const char* last,
                                                     const CsvColumn& column, char* row) {
  char* const to = row + column.offset;
  switch (column.type) {
    case CellType::f32:
      return parse_float(first, last, to);
    case CellType::u8:
      return parse_byte(first, last, to);
    case CellType::bit:
      return parse_bit(first, last, column.bit, to);
    case CellType::u64:
      return parse_integer(first, last, to);
    case CellType::f64:
      return parse_double(first, last, to);
    case CellType::text:
      return parse_text(first, last, to);
    case CellType::ignored:
      return std::find(first, last, ',');
  }
  return nullptr;
}

}  // namespace attest
