// The command line: which command, with which options. The sources of the commands do not include
// CLI11, because CLI11 takes longer to compile than all of them together.
#pragma once

namespace attest::cli {

// Does what the arguments say; returns the exit code (command.hpp).
int run_command_line(int argc, char** argv);

}  // namespace attest::cli
