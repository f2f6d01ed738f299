// What `attest time` and `attest stress` add for a port that is a program.
#pragma once

#include <string>

namespace attest::cli {

// The share of the exchange in the times of a program. Empty for another kind of port.
std::string exchange_note(const std::string& port);

}  // namespace attest::cli
