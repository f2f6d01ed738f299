// Text from files and ports as it is shown in messages.
#pragma once

#include <string>
#include <string_view>

namespace attest {

// The text with control characters as \xNN. On a terminal they would move the cursor or change the
// colours, so that a file could hide its error. UTF-8 stays.
std::string printable(std::string_view text);

// The same, but line ends stay.
std::string printable_lines(std::string_view text);

}  // namespace attest
