// A line that `attest time` and `attest stress` print for a port that is a program.
#pragma once

#include <string>

namespace attest::cli {

// Measures how long one exchange with a program takes. Empty for another kind of port.
std::string exchange_note(const std::string& port);

}  // namespace attest::cli
