// Failures that are known and accepted for a while: a file of patterns of ids, each with a reason.
// If a listed vector passes, the run fails, so that obsolete entries are removed.
//
//     [expected]
//     "px4-v1.5.5/tailsitter/latch@*" = "no recovery yet (#12)"
//     "px4-v1.5.5/tailsitter/fast@*" = "crash, timeout: no recovery yet (#12)"
//
// The reason may begin with the verdicts that the entry excuses. An entry without verdicts excuses
// `fail` and `non-finite` only, so a crash still fails the run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

struct ExpectedFailure {
  std::string pattern;  // shell pattern of ids, with or without the configuration
  std::string reason;   // as written, with its verdicts
  std::vector<Verdict> excused;

  bool excuses(Verdict verdict) const;
};

class ExpectedFailures {
 public:
  // `suite`: the ids of the suite's open-loop vectors (VectorResult::id). Errors: the file is
  // unreadable or not TOML, an unknown key, an entry without a reason, an entry that excuses a
  // whole profile: it matches all vectors of the profile in `suite`, and would match those of a new
  // group.
  static Result<ExpectedFailures> read(const std::filesystem::path& file,
                                       const std::vector<std::string>& suite);

  // Whether the result is a failure that an entry excuses.
  bool expects(const VectorResult& result) const;

  // A listed result becomes xfail if an entry excuses its verdict, and xpass if it passes.
  // `complete`: all vectors were run, so an entry that matches no result is an error of the run.
  void apply(bool complete, RunResult& run) const;

 private:
  void expect(VectorResult& result, std::vector<bool>& used) const;

  std::filesystem::path file_;
  std::vector<ExpectedFailure> entries_;
};

// The text of a file that lists the failures of this run, with their verdicts. A case gets one
// entry if all its configurations were run and failed, else one for each failing configuration.
std::string expected_failures_of(const RunResult& run);

}  // namespace attest
