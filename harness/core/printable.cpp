#include "harness/core/printable.hpp"

#include <fmt/format.h>

namespace attest {
namespace {

bool is_control(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte < 0x20 || byte == 0x7f;
}

std::string escaped(std::string_view text, bool keeps_line_ends) {
  std::string shown;
  shown.reserve(text.size());
  for (const char c : text) {
    if (is_control(c) && !(keeps_line_ends && c == '\n')) {
      shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      shown += c;
    }
  }
  return shown;
}

}  // namespace

std::string printable(std::string_view text) { return escaped(text, false); }

std::string printable_lines(std::string_view text) { return escaped(text, true); }

}  // namespace attest
