// Completion of the command line in shells, made of the same declarations as --help.
#pragma once

#include <string>

namespace CLI {
class App;
}  // namespace CLI

namespace attest::cli {

// The script for bash. It completes commands, options, fixed values, common rates, and the names of
// groups, cases, profiles and vehicles, which `attest list` prints. For all else the shell
// completes file names.
std::string bash_completion(const CLI::App& app);

// The same for zsh, as the file _attest of its function path.
std::string zsh_completion(const CLI::App& app);

}  // namespace attest::cli
