// Completion of the command line in shells, made of the same declarations as --help.
#pragma once

#include <string>

namespace CLI {
class App;
}  // namespace CLI

namespace attest::cli {

// The script for bash. It completes commands, options, fixed values, and the names of groups,
// cases, profiles and vehicles, for which it asks `attest list`. Anything else is a file.
std::string bash_completion(const CLI::App& app);

// The same for zsh, as the file _attest of its function path.
std::string zsh_completion(const CLI::App& app);

}  // namespace attest::cli
