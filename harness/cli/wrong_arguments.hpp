// What is wrong with a command line, where CLI11 says too little: each is one line, empty where
// nothing is wrong.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace attest::cli {

std::string unknown_command(const CLI::App& app, const std::string& word);

// For a command line that CLI11 did not expect: the first word that looks like an option and is
// not.
std::string unknown_option(const CLI::App& app, int argc, char** argv);

// After parsing. A value that no option can have: an empty text, as from a variable that is not
// set, or NaN and infinity, which pass every check of a range.
std::string wrong_value(const CLI::App& app);

}  // namespace attest::cli
