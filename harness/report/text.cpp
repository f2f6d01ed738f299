#include "harness/report/text.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace attest {
namespace {

bool special_in_shell(char c) {
  const bool word = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  return !word && std::string_view("_-./:=@%+,").find(c) == std::string_view::npos;
}

// Columns of UTF-8 text without the escape codes of colours.
std::size_t columns_of(std::string_view text) {
  std::size_t columns = 0;
  bool in_code = false;
  for (const char c : text) {
    if (c == '\x1b') in_code = true;
    const bool continues = (static_cast<unsigned char>(c) & 0xc0u) == 0x80u;
    columns += in_code || continues ? 0 : 1;
    if (c == 'm') in_code = false;
  }
  return columns;
}

// True for lines such as "reproduce: attest run ..." and "also at 250 Hz: --filter ...".
bool has_command(std::string_view line) {
  for (const std::string_view begin : {"attest ", "--filter "}) {
    const std::size_t at = line.find(begin);
    if (at == std::string_view::npos) continue;
    const std::size_t before = line.substr(0, at).find_last_not_of(' ');
    if (before != std::string_view::npos && line[before] == ':') return true;
  }
  return false;
}

std::string broken_line(std::size_t width, std::string_view line) {
  const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
  if (columns_of(line) <= width || has_command(line)) return std::string(line);
  std::string out(line.substr(0, indent));
  std::size_t used = indent;
  for (std::size_t begin = indent; begin < line.size();) {
    const std::size_t end = std::min(line.find(' ', begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    const bool is_first = begin == indent;
    // A word that is too long for the next line also stays on this line.
    const bool fits_below = indent + 4 + columns_of(word) <= width;
    if (!is_first && fits_below && used + 1 + columns_of(word) > width) {
      out += "\n" + std::string(indent + 4, ' ');
      used = indent + 4;
    } else if (!is_first) {
      out += ' ';
      ++used;
    }
    out += word;
    used += columns_of(word);
    begin = end + 1;
  }
  return out;
}

}  // namespace

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

std::string broken_at(int width, std::string_view text) {
  if (width <= 0) return std::string(text);
  std::vector<std::string> lines = lines_of(text);
  for (std::string& line : lines) line = broken_line(static_cast<std::size_t>(width), line);
  return fmt::format("{}{}", fmt::join(lines, "\n"), text.ends_with('\n') ? "\n" : "");
}

std::string capitals(std::string_view word) {
  std::string out(word);
  for (char& letter : out)
    letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return out;
}

std::string one_line(std::string_view text) {
  std::string out;
  for (const char c : printable(text)) {
    const bool space = c == '\n' || c == '\t' || c == ' ';
    if (!space)
      out += c;
    else if (!out.empty() && out.back() != ' ')
      out += ' ';
  }
  if (!out.empty() && out.back() == ' ') out.pop_back();
  return out;
}

std::string shell_quoted(std::string_view text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'')
      out += "'\\''";
    else
      out += c;
  }
  return out + "'";
}

std::string shell_word(std::string_view text) {
  const bool plain = !text.empty() && std::none_of(text.begin(), text.end(), special_in_shell);
  return plain ? std::string(text) : shell_quoted(text);
}

std::string counted(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

}  // namespace attest
