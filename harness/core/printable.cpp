#include "harness/core/printable.hpp"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

namespace attest {
namespace {

// The length in bytes of the UTF-8 character at the beginning of `text`; 0 if `text` begins with
// bytes that are not UTF-8. REQUIRES: not empty.
std::size_t utf8_length(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t lead = byte(0);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
  }
  const bool overlong = (lead == 0xe0 && byte(1) < 0xa0) || (lead == 0xf0 && byte(1) < 0x90);
  const bool surrogate = lead == 0xed && byte(1) >= 0xa0;
  const bool beyond = lead == 0xf4 && byte(1) >= 0x90;
  return overlong || surrogate || beyond ? 0 : length;
}

bool harmless(std::string_view character) {
  const auto lead = static_cast<std::uint8_t>(character[0]);
  if (character.size() == 1) return lead >= 0x20 && lead != 0x7f;
  // C1 controls are U+0080 to U+009F; terminals obey some of them.
  if (character.size() == 2 && lead == 0xc2) return static_cast<std::uint8_t>(character[1]) >= 0xa0;
  return character != "\xef\xbf\xbe" && character != "\xef\xbf\xbf";
}

// `kept`: the control characters that are not escaped.
std::string escaped(std::string_view text, std::string_view kept) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = std::max<std::size_t>(utf8_length(text), 1);
    const std::string_view character = text.substr(0, length);
    const bool stays = harmless(character) || kept.find(character) != std::string_view::npos;
    if (utf8_length(text) != 0 && stays) {
      out += character;
    } else {
      for (const char c : character) out += fmt::format("\\x{:02x}", static_cast<std::uint8_t>(c));
    }
    text.remove_prefix(length);
  }
  return out;
}

}  // namespace

std::string printable(std::string_view text) { return escaped(text, "\n\t"); }

std::string printable_part(std::string_view text) { return escaped(text, ""); }

}  // namespace attest
