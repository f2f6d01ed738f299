// `attest vectors`: writes inputs, makes cases of a log, or reports margins.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/cli/globals.hpp"

namespace attest::cli {

struct VectorOptions {
  SelectionOptions select;
  std::string folder;
  std::string format = "csv";
  std::string fixed_step;  // a rate [Hz]; empty: no fixed step
  std::vector<std::string> parameters;
  bool lint = false;
  bool verbose = false;  // the lint looks for cases on and next to each threshold, too
  // If not empty: the command makes a case from this log. The times are from the first step in the
  // log.
  std::string from_log;
  double from_s = 0;
  std::optional<double> to_s;        // empty: to the end
  std::vector<std::string> assumed;  // assumption_words()
};

int vectors_from_log(const VectorOptions& options, const Globals& globals);
int lint(const VectorOptions& options, const Globals& globals);

}  // namespace attest::cli
