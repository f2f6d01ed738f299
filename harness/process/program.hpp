// Programs that others keep, used where they are installed.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/process/process.hpp"

namespace attest {

// In the folders of PATH.
bool is_installed(const std::string& program);

// Starts a program of PATH without input; what it prints is dropped. It exits with status 127 when
// it cannot be executed.
Result<Process> start_program(const std::vector<std::string>& command);

struct ProgramLimits {
  double timeout_s = 10;
  std::function<bool()> stop = [] { return false; };  // true: its output is not needed any more
};

// Runs it to its end without input: what it printed on stdout. Empty when it failed, printed more
// than 16 MiB, or did not end within the limits; then it is stopped.
std::optional<std::string> output_of(const std::vector<std::string>& command,
                                     const ProgramLimits& limits);

}  // namespace attest
