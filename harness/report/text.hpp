// Texts of a port (its name, the reason of its failure) as they reach a terminal, an XML file or a
// shell.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "harness/core/printable.hpp"

namespace attest {

// Breaks lines that are longer than `width` columns at spaces. What follows is indented by 4
// columns more than the line. Not counted: escape codes of colours. Not broken: lines of a command
// to copy
// ("reproduce: attest ..."), and words that are longer. 0: breaks no line.
std::string broken_at(int width, std::string_view text);

// As printable(), and on one line: each run of newlines and tabs becomes one space.
std::string one_line(std::string_view text);

// As one word of a POSIX shell: unchanged when nothing in it is special, else 'in quotes'.
std::string shell_word(std::string_view text);
std::string shell_quoted(std::string_view text);

// "1 case", "2 cases".
std::string counted(std::size_t count, std::string_view noun);

}  // namespace attest
