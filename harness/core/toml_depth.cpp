#include "harness/core/toml_depth.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>

#include <fmt/format.h>

namespace attest {
namespace {

// The offset that a search found, or the end of the text.
std::size_t or_end(std::size_t found, std::string_view text) {
  return std::min(found, text.size());
}

// The offset of the first unescaped `closing` from `at` on; the end of the text if there is none.
std::size_t find_unescaped(std::string_view text, std::string_view closing, std::size_t at) {
  while (at < text.size() && !text.substr(at).starts_with(closing)) {
    at += text[at] == '\\' ? 2 : 1;
  }
  return or_end(at, text);
}

// The offset behind the string whose opening quote is at `begin`.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const auto find = [&](std::string_view closing, std::size_t at) {
    return quote == '"' ? find_unescaped(text, closing, at) : or_end(text.find(closing, at), text);
  };
  const std::string_view triple = quote == '"' ? "\"\"\"" : "'''";
  if (!text.substr(begin).starts_with(triple)) {
    return or_end(find(triple.substr(0, 1), begin + 1) + 1, text);
  }
  std::size_t end = or_end(find(triple, begin + triple.size()) + triple.size(), text);
  // A multi-line string may end in up to five quotes: the last three close it, the others are text.
  for (int i = 0; i < 2 && end < text.size() && text[end] == quote; ++i) ++end;
  return end;
}

// The offset at which the nesting is too deep; empty if it never is.
std::optional<std::size_t> find_too_deep(std::string_view text) {
  constexpr std::string_view ends_a_key = "=,{}[]\n";
  int parts = 1, values = 0;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      at = end_of_string(text, at);
      continue;
    }
    if (c == '#') {
      at = or_end(text.find('\n', at), text);
      continue;
    }
    if (ends_a_key.find(c) != std::string_view::npos) parts = 1;
    parts += c == '.' ? 1 : 0;
    values += c == '[' || c == '{' ? 1 : 0;
    values -= c == ']' || c == '}' ? 1 : 0;
    if (parts > most_levels || values > most_levels) return at;
    ++at;
  }
  return std::nullopt;
}

}  // namespace

Result<void> check_depth(std::string_view text, const std::string& name) {
  const auto deep = find_too_deep(text);
  if (!deep) return {};
  const std::string_view before = text.substr(0, *deep);
  const std::string_view line = before.substr(before.rfind('\n') + 1);  // no newline: npos + 1 is 0
  // The column is in characters, as in toml++: a UTF-8 sequence is one.
  const auto is_first_byte = [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; };
  return fail_at(
      name,
      fmt::format("tables or arrays are nested more than {} deep; no file of attest needs "
                  "that",
                  most_levels),
      1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')),
      1 + static_cast<int>(std::count_if(line.begin(), line.end(), is_first_byte)));
}

}  // namespace attest
