// The command line: which command, with which options (command.hpp).
#pragma once

namespace attest::cli {

// Does what the arguments say; returns the exit code (globals.hpp).
int run_command_line(int argc, char** argv);

}  // namespace attest::cli
