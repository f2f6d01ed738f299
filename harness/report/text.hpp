// Makes texts of a port (its name, the reason of its failure) harmless before they reach a
// terminal, an XML file or a shell.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace attest {

// Valid UTF-8 that XML 1.0 can hold and that does not move a cursor: control characters other than
// newline and tab, U+FFFE, U+FFFF and bytes that are not UTF-8 become "\x1b".
std::string printable(std::string_view text);

// The same on one line: each run of newlines and tabs becomes one space.
std::string one_line(std::string_view text);

// As one word of a POSIX shell: unchanged when nothing in it is special, else 'in quotes'.
std::string shell_word(std::string_view text);
std::string shell_quoted(std::string_view text);

// "1 case", "2 cases".
std::string counted(std::size_t count, std::string_view noun);

}  // namespace attest
