// Checks that a command overwrites no file that it reads, and no report of its own.
#pragma once

#include <string>
#include <vector>

#include "harness/cli/suite_folder.hpp"
#include "harness/core/result.hpp"

namespace attest::cli {

// The files that a command reads, in addition to the suite. Empty texts are ignored.
struct Inputs {
  std::string port;                // as for open_port: its files are read
  std::vector<std::string> files;  // expected failures, timing, tasks, a case by its path
};

// Errors: a file of `outputs` is named twice, is one of the inputs, or is an existing file of the
// suite (a case, golden, recording or model). Symbolic links are followed. Empty outputs are
// ignored. Call it before the command writes or runs anything.
Result<void> check_outputs(const std::vector<std::string>& outputs, const Inputs& inputs,
                           const SuiteFolder& suite);
// The same for a command that works without a suite. `suite_folder`: as for find_suite(). If there
// is no suite, only the inputs are protected.
Result<void> check_outputs(const std::vector<std::string>& outputs, const Inputs& inputs,
                           const std::string& suite_folder);

// Makes the folder for saved traces. Does nothing if the name is empty. Errors: the folder is not
// empty, so that traces of an earlier run could be mistaken for those of this run; it cannot be
// made or written; it is in a folder of the suite.
Result<void> prepare_trace_folder(const std::string& folder, const SuiteFolder& suite);

// Errors: `folder`, the output folder of many files, is a folder of the suite or lies in one.
Result<void> check_output_folder(const std::string& folder, const SuiteFolder& suite);

}  // namespace attest::cli
