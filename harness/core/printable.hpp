// Makes texts from files and ports harmless before they reach a terminal or an XML file.
#pragma once

#include <string>
#include <string_view>

namespace attest {

// Valid UTF-8 that XML 1.0 can hold and that does not move a cursor: control characters other than
// newline and tab, U+FFFE, U+FFFF and bytes that are not UTF-8 become "\x1b".
std::string printable(std::string_view text);

// The same for a part of a line: newlines and tabs become "\x0a" and "\x09", too.
std::string printable_part(std::string_view text);

}  // namespace attest
