// `proc:COMMAND`: a program that reads requests on stdin and answers on stdout (PROTOCOL.md).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/port/port.hpp"

namespace attest {

// Splits COMMAND into words as a POSIX shell does, without running anything. Errors: no word, a
// quote that is not closed, an unknown variable, command substitution, a character that only a
// shell can handle.
Result<std::vector<std::string>> words_of(const std::string& command);

// The program, and each of its arguments that is a file.
std::vector<std::string> files_of_program(const std::string& command);

// Starts the program and makes the handshake. A program that ends, or breaks the protocol, is
// started again at the next create_unit(). Errors: those of words_of(); no such program; it does
// not answer the handshake as it must.
Result<std::unique_ptr<Port>> open_program(const std::string& command);

}  // namespace attest
