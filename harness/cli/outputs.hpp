// Checks that a command writes into no suite, and overwrites no file that it reads and no report of
// its own.
#pragma once

#include <string>
#include <vector>

#include "harness/core/result.hpp"

namespace attest::cli {

// The files that a command reads, in addition to the suite. Empty texts are ignored.
struct Inputs {
  std::string port;                // as for open_port: its files are read
  std::vector<std::string> files;  // expected failures, timing, tasks, a case by its path
};

// The functions below take the suite of the command as find_suite() takes it. They protect the
// cases, goldens and models of every suite: of this one, and of any folder that has cases/ and
// golden/ or a BASE. They also protect the data of this attest. Symbolic links are followed.

// Errors: a file of `outputs` is named twice, is one of the inputs, or is in a suite. Empty outputs
// are ignored. Call it before the command writes or runs anything.
Result<void> check_outputs(const std::vector<std::string>& outputs, const Inputs& inputs,
                           const std::string& suite);

// Makes the folder for saved traces. Does nothing if the name is empty. Errors: the folder is not
// empty, so that traces of an earlier run could be mistaken for those of this run; it cannot be
// made or written; it is a suite or in one.
Result<void> prepare_trace_folder(const std::string& folder, const std::string& suite);

// Errors: `folder`, the output folder of many files, is a suite or in one.
Result<void> check_output_folder(const std::string& folder, const std::string& suite);

// For a command that adds cases to the suite of a user. Errors: `suite` is that of this attest.
Result<void> check_own_suite(const std::string& suite);

// The file of the attitude unit's trace, next to the rate unit's: "flown.attitude_unit.csv". Empty:
// that trace is not written, because `file` is empty, or is stdout, which takes one trace.
std::string attitude_unit_file(const std::string& file);

}  // namespace attest::cli
