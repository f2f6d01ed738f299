// What `attest time` and `attest stress` add for a port that is a program.
#pragma once

#include <string>

namespace attest::cli {

// The share of pipes in the times of a program, in one line. Empty for another kind of port.
std::string pipes_note(const std::string& port);

}  // namespace attest::cli
