// Errors of a command line for which CLI11's messages are too short. Each function returns one
// line; empty: no error.
#pragma once

#include <string>

#include "harness/cli/globals.hpp"

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace attest::cli {

std::string unknown_command(const CLI::App& app, const std::string& word);

// For a command line that CLI11 rejects: the first word that starts with `--` and is not an option.
std::string unknown_option(const CLI::App& app, int argc, char** argv);

// For any other command line that CLI11 rejects: its message, and where the options are described.
std::string wrong_usage(const CLI::App& app, const CLI::ParseError& error);

// After parsing. Finds values that no option accepts: an empty text, for example from an unset
// shell variable, and NaN and infinity, which pass the range checks of CLI11.
std::string wrong_value(const CLI::App& app);

// What is given as the port, but is a case, or the script that judges a port; with the command that
// was meant. Empty: neither.
std::string wrong_port(const CLI::App& app, const Globals& globals);

}  // namespace attest::cli
