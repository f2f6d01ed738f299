// Completion of the command line in shells, made of the same declarations as --help.
#pragma once

#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace attest::cli {

// "FLOAT": the type of an option's value, without the checks that CLI11 appends.
std::string value_name(const CLI::Option& option);

// The script for bash. It completes commands, options, fixed values, common rates, kinds of port
// with their files, and the names of groups, cases, profiles, vehicles and faults, which attest
// lists. For all else the shell completes file names.
std::string bash_completion(const CLI::App& app);

// The same for zsh, with descriptions, as the file _attest of its function path.
std::string zsh_completion(const CLI::App& app);

}  // namespace attest::cli
