// At a tie, both branches of the law are accepted.
//
// There are two ties: a yaw error of 180 deg, and a direct rotation of 180 deg. There the sign of a
// last bit decides the law's direction of rotation. A case at such a tie (Case::either_branch) has
// several goldens: the outputs of the law, and its outputs with such decisions on their other
// branch.
#pragma once

#include <map>
#include <string>

#include "harness/casefile/case.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// The key names the decisions on their other branch: "yaw_wrap", "yaw_wrap+shorter_rotation".
using BranchAlternatives = std::map<std::string, Trace>;

// The reference's outputs for the inputs of `law`, on every other branch that the case allows;
// `law` has the outputs on the law's own branch. Errors: the integrals differ between the branches,
// so that the choice affects later ticks; no tick is on the threshold; the profile is unknown.
Result<BranchAlternatives> branch_alternatives(const Case& the_case, const Trace& law);

// A copy of `law`. At each tick at which `got` agrees with another branch and not with the law, it
// has the outputs of that branch. If `got` agrees with none of them, the nearest counts. REQUIRES:
// the same number of samples in all.
Trace on_the_branch_of(const Trace& got, const Trace& law, const BranchAlternatives& others,
                       const Tolerances& tolerances);

}  // namespace attest
