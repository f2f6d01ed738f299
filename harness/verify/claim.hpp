// The conformance claims that a run supports. Each profile has its own, because a port may
// implement one version of the law only.
//
// A port conforms to a profile when it passed the released suite: every group that is not an
// optional module (mixer, battery estimate), every rate, every case. Cases of the exact level may
// be skipped at another level. Anything less is partial, and the claim names the missing parts.
#pragma once

#include <string>
#include <vector>

#include "harness/verify/run_result.hpp"

namespace attest {

struct Claim {
  std::string profile;
  // Groups, in alphabetical order. Whole: every case passed at all rates that were run.
  std::vector<std::string> whole, in_part, failing;
  // Optional modules that are whole. A module that fails is in `failing` instead.
  std::vector<std::string> modules;
  bool has_all_groups = false;  // `whole` has all mandatory groups
  std::vector<std::string>
      missing;  // "custom suite", "2 vectors unsupported (tpa)"; empty: conforms

  bool conforms() const { return failing.empty() && missing.empty(); }
};

// One for each profile with a judged case, sorted. A profile that the port does not support has no
// claim: all its cases are skipped.
std::vector<Claim> claims_of(const RunResult& run);

enum class Standing { conformant, partial, none };

// Of the whole run. None: a case failed, an error occurred, the run stopped early, or no case
// passed. Conformant: the port conforms to at least one profile.
Standing standing_of(const RunResult& run);

}  // namespace attest
