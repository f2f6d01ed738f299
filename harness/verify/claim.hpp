// What a run entitles a port to claim, one profile at a time: a port may be the same controller in
// one version of the law only.
//
// A port conforms to a profile when it passed the released suite: every group that is not an
// optional module (mixer, battery estimate), every rate, every case. Only the cases of the exact
// level may be skipped, at another level. Anything less is partial, and what is missing is named.
#pragma once

#include <string>
#include <vector>

#include "harness/verify/run_result.hpp"

namespace attest {

struct Claim {
  std::string profile;
  // Groups, in alphabetical order. Whole: every case passed at all rates that were run.
  std::vector<std::string> whole, in_part, failing;
  std::vector<std::string>
      modules;                  // optional ones that are whole; in no other list unless failing
  bool has_all_groups = false;  // `whole` has all that are mandatory
  std::vector<std::string> missing;  // "custom suite", "2 cases unsupported (tpa)"; empty: conforms

  bool conforms() const { return failing.empty() && missing.empty(); }
};

// Of each profile of which something was judged, sorted. A profile that the port does not support,
// of which all cases are skipped, has none.
std::vector<Claim> claims_of(const RunResult& run);

enum class Standing { conformant, partial, none };

// Of the run as a whole. None: something failed, an error, an end before the end, nothing passed.
// Conformant: the port conforms to a profile at least.
Standing standing_of(const RunResult& run);

}  // namespace attest
