// External programs. Most are optional: attest uses them if they are installed.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/process/process.hpp"

namespace attest {

// The file that would be executed: `program` itself if it has a slash, or else a file in a folder
// of PATH. Empty: no such file may be executed.
std::optional<std::string> find_program(const std::string& program);
bool is_installed(const std::string& program);

// Descriptors for a program, which remain the caller's. -1: no input, or the output is discarded.
struct ProgramFiles {
  int in = -1, out = -1, error = -1;
  int fourth = -1;  // descriptor 3 of the program; -1: it has none
};

// Starts the program command[0], which is searched in PATH. It gets no descriptors other than
// `files`. The process exits with status 127 if the program cannot be executed.
Result<Process> start_program(const std::vector<std::string>& command,
                              const ProgramFiles& files = {});

struct ProgramLimits {
  double timeout_s = 10;
  std::function<bool()> stop = [] { return false; };  // true: stop the program
};

// Runs a program to its end without input. Returns its stdout. Empty when it failed, printed more
// than 16 MiB, or did not end within the limits; in the last two cases it is stopped.
std::optional<std::string> output_of(const std::vector<std::string>& command,
                                     const ProgramLimits& limits);

}  // namespace attest
