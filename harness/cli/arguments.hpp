// The command line: which command, with which options (command_line.hpp).
#pragma once

namespace attest::cli {

// Does what the arguments say; returns the exit code (command.hpp).
int run_command_line(int argc, char** argv);

}  // namespace attest::cli
