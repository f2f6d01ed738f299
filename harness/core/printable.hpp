// Makes texts from files and ports harmless before they reach a terminal or an XML file.
#pragma once

#include <string>
#include <string_view>

namespace attest {

// Returns UTF-8 that XML 1.0 can hold and that cannot control a terminal. Each byte of these
// becomes an escape of four characters such as `\x1b`: control characters other than newline and
// tab, U+FFFE, U+FFFF, and bytes that are not UTF-8.
std::string printable(std::string_view text);

// The same for a part of a line: newline and tab also become `\x0a` and `\x09`.
std::string printable_part(std::string_view text);

}  // namespace attest
