// Prepares texts of a port (its name, the reason of its failure) for a terminal, an XML file or a
// shell.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "harness/core/printable.hpp"

namespace attest {

// Breaks lines that are longer than `width` columns at spaces; 0 breaks no line. The continuation
// is indented by 4 columns more than the line. Escape codes of colours do not count. Lines with a
// command to copy ("reproduce: attest ...") are not broken, nor are words that are too long for a
// line.
std::string broken_at(int width, std::string_view text);

// As printable(), and on one line: each run of newlines, tabs and spaces becomes one space. Removes
// white space at both ends.
std::string one_line(std::string_view text);

std::vector<std::string> lines_of(std::string_view text);

// One word of a POSIX shell. shell_word() adds quotes only if the text is empty or has a special
// character; shell_quoted() always adds them.
std::string shell_word(std::string_view text);
std::string shell_quoted(std::string_view text);

std::string capitals(std::string_view word);  // "PASS"

// "1 case", "2 cases".
std::string counted(std::size_t count, std::string_view noun);

}  // namespace attest
