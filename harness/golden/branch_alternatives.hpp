// Where the law turns one way, and the other is as right.
//
// At a yaw error of 180 deg, and at a direct rotation of 180 deg, the sign of a last bit decides
// which way the law turns. A case that stands there (Case::either_branch) has more goldens than
// one: what the law answers, and what it answers when such decisions fall on their other branch.
#pragma once

#include <map>
#include <string>

#include "harness/casefile/case.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// By the decisions that fall on their other branch: "yaw_wrap", "yaw_wrap+shorter_rotation".
using BranchAlternatives = std::map<std::string, Trace>;

// The reference's answers to the inputs of `law` on every other branch that the case allows; `law`
// has its answers on this one. Errors: the integrals are not the same on both, so that the branches
// are not a matter of a tick; no tick is on the threshold; the profile is unknown.
Result<BranchAlternatives> branch_alternatives(const Case& the_case, const Trace& law);

// `law` with the answers of another branch at those ticks at which `got` agrees with them and not
// with the law's, or is nearer to them. REQUIRES: as many samples in all.
Trace on_the_branch_of(const Trace& got, const Trace& law, const BranchAlternatives& others,
                       const Tolerances& tolerances);

}  // namespace attest
