// The conformance claims that a run supports. Each profile has its own, because a port may
// implement one version of the law only.
//
// A port conforms to a profile if no case failed, and all cases of the released suite passed: every
// rate and every group, except the optional modules (mixer, battery estimate, pure laws). If the
// port declares no unit of the profile, the claim is about its optional modules: a law alone. Cases
// that are compared at the exact level only may be skipped at another level
// (VectorResult::exact_only), but of each group at least one vector must be compared. A port with a
// fixed step, changed parameters, declared lacks, a topic that it does not publish, or no process
// of its own does not conform. A claim names the groups that fail, and what is missing.
//
// At the level events a port does not conform, because the wide bounds of that level pass some
// faults of the catalogue (tests/QUALITY.md). The claim is then that its events agree.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/verify/run_result.hpp"

namespace attest {

struct Claim {
  std::string profile;
  Level level = Level::numeric;
  // Groups, in alphabetical order. `whole`: all cases passed, at all rates that were run.
  // `in_part`: some cases passed, and none failed. `failing`: a case failed.
  std::vector<std::string> whole, in_part, failing;
  // Optional modules of which all cases passed. They are not in `whole`; a module of which a case
  // failed is in `failing`.
  std::vector<std::string> modules;
  bool has_all_groups = false;  // all groups except optional modules are in `whole`
  bool is_of_modules = false;   // the port has no unit of the profile
  std::vector<std::string>
      missing;  // reasons against conformance: "custom suite", "2 vectors unsupported (tpa)"

  bool is_complete() const {
    const bool has_all = is_of_modules ? !modules.empty() : has_all_groups;
    return failing.empty() && missing.empty() && has_all;
  }
  bool conforms() const { return is_complete() && level != Level::events; }
};

// One claim for each profile in which a case passed or failed, sorted by profile. A profile that
// the port does not support has no claim, because all its cases are skipped.
std::vector<Claim> claims_of(const RunResult& run);

enum class Standing { conformant, events_agree, partial, none };

std::string_view name_of(Standing standing);  // "events agree"

// The standing of the whole run. `none`: a verdict fails the run, an error occurred, the run
// stopped early, or no case passed. Otherwise `conformant` if the port conforms to at least one
// profile, and `events_agree` if a claim at the level events is complete.
Standing standing_of(const RunResult& run);

}  // namespace attest
