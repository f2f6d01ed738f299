// External programs, used where they are installed.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/process/process.hpp"

namespace attest {

// True if a folder of PATH has this program.
bool is_installed(const std::string& program);

// Starts a program of PATH without input and discards its output. The process exits with status 127
// when the program cannot be executed.
Result<Process> start_program(const std::vector<std::string>& command);

struct ProgramLimits {
  double timeout_s = 10;
  std::function<bool()> stop = [] { return false; };  // true: its output is not needed any more
};

// Runs a program to its end without input. Returns its stdout. Empty when it failed, printed more
// than 16 MiB, or did not end within the limits; in the last two cases it is stopped.
std::optional<std::string> output_of(const std::vector<std::string>& command,
                                     const ProgramLimits& limits);

}  // namespace attest
