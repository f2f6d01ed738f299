// Failures that are known and accepted for a while: a file of case ids, each with a reason. A
// listed case that passes is reported and fails the run, so that obsolete entries are removed.
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

  // A listed result that fails becomes xfail, and one that passes xpass. `complete`: no result was
  // filtered out. Then an entry that matches no result is an error of the run.
  void apply(bool complete, RunResult& run) const;

 private:
  std::filesystem::path file_;
  std::vector<ExpectedFailure> entries_;
};

// The file for the failures of this run. A case gets one entry if all its configurations were run
// and failed, else one per failing configuration.
std::string expected_failures_of(const RunResult& run);

}  // namespace attest
