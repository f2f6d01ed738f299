// Failures that are known and accepted for a while: a file of case ids, each with a reason. One
// that passes is told, and fails the run: the list must not outlive what it excuses.
//
//     [expected]
//     "px4-v1.5.5/tailsitter/latch@*" = "no recovery yet (#12)"
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

struct ExpectedFailure {
  std::string pattern;  // shell pattern of ids, as --filter, or of ids without the configuration
  std::string reason;
};

class ExpectedFailures {
 public:
  // Errors: unreadable, not TOML, an unknown key, an entry without a reason, one that names neither
  // a group nor a case.
  static Result<ExpectedFailures> read(const std::filesystem::path& file);

  bool expects(const CaseResult& result) const;

  // What fails and is listed becomes xfail, what passes and is listed xpass. An entry that names no
  // result is an error of the run when `complete`: when nothing was filtered out.
  void apply(bool complete, RunResult& run) const;

 private:
  std::filesystem::path file_;
  std::vector<ExpectedFailure> entries_;
};

// The file for what fails in this run: one entry a case when it fails at all its configurations and
// all were run, else one a configuration.
std::string expected_failures_of(const RunResult& run);

}  // namespace attest
