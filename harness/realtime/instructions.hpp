// Instructions that a function executes, counted by valgrind: unlike times, they repeat.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/process/program.hpp"

namespace attest {

// Runs `command` under callgrind and counts each call of `symbol`, what it calls included, in their
// order. Empty when valgrind is not installed, the command fails or does not end within the limits,
// or nothing was called.
std::vector<std::uint64_t> instructions_of_calls(const std::vector<std::string>& command,
                                                 const std::string& symbol,
                                                 const ProgramLimits& limits);

}  // namespace attest
