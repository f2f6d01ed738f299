// A command overwrites no file that it reads, and no report of its own.
#pragma once

#include <string>
#include <vector>

#include "harness/cli/suite_folder.hpp"
#include "harness/core/result.hpp"

namespace attest::cli {

// What a command reads, in addition to the suite; an empty text is no file.
struct Inputs {
  std::string port;                // as for open_port: `lib:PATH` is a file
  std::vector<std::string> files;  // expected failures, timing, tasks, a case by its path
};

// Errors: a file of `outputs` that is to be written twice, that is one of the inputs, or that is a
// file of the suite (a case, golden, recording or model); symbolic links are followed. An empty
// output is none. To be asked before anything runs.
Result<void> check_outputs(const std::vector<std::string>& outputs, const Inputs& inputs,
                           const SuiteFolder& suite);

// Errors: `folder`, in which many files are to be written, is one of the suite or lies in one.
Result<void> check_output_folder(const std::string& folder, const SuiteFolder& suite);

}  // namespace attest::cli
