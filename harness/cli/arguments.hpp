// The command line: which command, with which options. CLI11 stays inside arguments.cpp, which
// costs more to compile than all commands together.
#pragma once

namespace attest::cli {

// Does what the arguments say; returns the exit code (command.hpp).
int run_command_line(int argc, char** argv);

}  // namespace attest::cli
