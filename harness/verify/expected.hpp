// Failures that are known and accepted for a while: a file of case ids, each with a reason. A
// listed case that passes is reported and fails the run, so that obsolete entries are removed.
//
//     [expected]
//     "px4-v1.5.5/tailsitter/latch@*" = "no recovery yet (#12)"
//     "px4-v1.5.5/tailsitter/fast@*" = "crash, timeout: no recovery yet (#12)"
//
// The reason may begin with the verdicts that the entry excuses. Without them it excuses `fail` and
// `non-finite`, so a port that crashes later fails the run.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

struct ExpectedFailure {
  std::string pattern;  // shell pattern of ids, as --filter, or of ids without the configuration
  std::string reason;   // as written, with its verdicts
  std::vector<Verdict> excused;

  bool excuses(Verdict verdict) const;
};

class ExpectedFailures {
 public:
  // `suite`: the ids of all its open-loop vectors (CaseResult::id). Errors: unreadable, not TOML,
  // an unknown key, an entry without a reason, an entry that excuses a whole profile. Such an entry
  // matches each vector of the profile in `suite`, and would match those of a new group too.
  static Result<ExpectedFailures> read(const std::filesystem::path& file,
                                       const std::vector<std::string>& suite);

  // Whether the result is a failure that an entry excuses.
  bool expects(const CaseResult& result) const;

  // A listed result becomes xfail if an entry excuses its verdict, and xpass if it passes.
  // `complete`: no result was filtered out. Then an entry that matches no result is an error of the
  // run.
  void apply(bool complete, RunResult& run) const;

 private:
  void expect(CaseResult& result, std::vector<bool>& used) const;

  std::filesystem::path file_;
  std::vector<ExpectedFailure> entries_;
};

// The file for the failures of this run, with their verdicts. A case gets one entry if all its
// configurations were run and failed, else one per failing configuration.
std::string expected_failures_of(const RunResult& run);

}  // namespace attest
