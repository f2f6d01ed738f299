// Texts of a port (its name, the reason of its failure) as they reach a terminal, an XML file or a
// shell.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "harness/core/printable.hpp"

namespace attest {

// As printable(), and on one line: each run of newlines and tabs becomes one space.
std::string one_line(std::string_view text);

// As one word of a POSIX shell: unchanged when nothing in it is special, else 'in quotes'.
std::string shell_word(std::string_view text);
std::string shell_quoted(std::string_view text);

// "1 case", "2 cases".
std::string counted(std::size_t count, std::string_view noun);

}  // namespace attest
