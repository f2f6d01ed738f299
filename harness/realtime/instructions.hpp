// Counts the instructions of a function with valgrind. Unlike times, the counts are the same in
// each run.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/process/program.hpp"

namespace attest {

// Runs `command` under callgrind and counts the instructions of each call of `symbol`, callees
// included, in order. Empty when valgrind is not installed, the command fails or does not end
// within the limits, or `symbol` was not called.
std::vector<std::uint64_t> instructions_of_calls(const std::vector<std::string>& command,
                                                 const std::string& symbol,
                                                 const ProgramLimits& limits);

}  // namespace attest
