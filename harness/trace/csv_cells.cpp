#include "harness/trace/csv_cells.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "harness/core/printable.hpp"

namespace attest {
namespace {

// The place of the first digit that is not zero, relative to the point: 1 for 1.5, -2 for 0.001. An
// exponent is added; one that overflows 64 bits counts as +-2^62.
std::int64_t magnitude(std::string_view number) {
  const std::size_t e = number.find_first_of("eE");
  std::int64_t exponent = 0;
  if (e != std::string_view::npos) {
    std::string_view digits = number.substr(e + 1);
    if (digits.starts_with('+')) digits.remove_prefix(1);
    const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
    constexpr std::int64_t enormous = std::int64_t{1} << 62;
    if (parsed.ec != std::errc()) exponent = digits.starts_with('-') ? -enormous : enormous;
  }
  std::string_view mantissa = number.substr(0, e);
  mantissa.remove_prefix(std::min(mantissa.find_first_not_of("+-0"), mantissa.size()));
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  if (point > 0) return exponent + static_cast<std::int64_t>(point);
  const std::size_t zeros = mantissa.find_first_not_of(".0");
  return exponent + 1 - static_cast<std::int64_t>(std::min(zeros, mantissa.size()));
}

}  // namespace

const char* parse_unusual_float(const char* first, const char* last, float& value) {
  const bool plus = first != last && *first == '+';
  const bool two_signs = plus && first + 1 != last && first[1] == '-';
  if (two_signs) return nullptr;
  const char* const begin = plus ? first + 1 : first;
  const auto parsed = std::from_chars(begin, last, value);
  if (parsed.ec == std::errc()) return parsed.ptr;
  if (parsed.ec != std::errc::result_out_of_range) return nullptr;
  const std::string_view number(begin, static_cast<std::size_t>(parsed.ptr - begin));
  if (magnitude(number) > 0) return nullptr;
  value = *begin == '-' ? -0.0f : 0.0f;
  return parsed.ptr;
}

std::string in_backquotes(std::string_view text) {
  constexpr std::size_t longest = 60;
  return fmt::format("`{}{}`", printable_part(text.substr(0, longest)),
                     text.size() > longest ? "..." : "");
}

std::string cell_error(std::string_view cell, CellType type, std::string_view column) {
  const std::string shown = cell.empty() ? "an empty cell" : in_backquotes(cell);
  switch (type) {
    case CellType::u64:
      return fmt::format(
          "{} is not an integer for {}; write an integer from 0 to 18446744073709551615", shown,
          column);
    case CellType::u8:
      return fmt::format("{} is not a flag for {}; write an integer from 0 to 255", shown, column);
    case CellType::bit:
      return fmt::format("{} is not a bit for {}; write 0 or 1", shown, column);
    case CellType::f32:
    case CellType::f64:
    case CellType::text:
    case CellType::ignored:
      break;
  }
  float value = 0;
  const char* const last = cell.data() + cell.size();
  const auto parsed = std::from_chars(cell.data(), last, value);
  const bool is_too_large = parsed.ec == std::errc::result_out_of_range && parsed.ptr == last;
  if (is_too_large && type == CellType::f32) {
    return fmt::format("{} is too large for {}, a 32-bit float; write inf or -inf for infinity",
                       shown, column);
  }
  return fmt::format("{} is not a number for {}; write a decimal number, nan, inf or -inf", shown,
                     column);
}

}  // namespace attest
