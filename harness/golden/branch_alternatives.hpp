// At a tie, both branches of the law are accepted.
//
// There are two ties: a yaw error of 180 deg, and a direct rotation (from the attitude to its
// setpoint) of 180 deg. There the sign of a last bit decides the law's direction of rotation. A
// case at such a tie (Case::either_branch) has several goldens: the outputs of the law, and the
// outputs of the law with these decisions on the other branch.
#pragma once

#include <map>
#include <string>

#include "harness/casefile/case.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// The key names the decisions that are on their other branch: "yaw_wrap", "shorter_rotation" or
// "yaw_wrap+shorter_rotation".
using BranchAlternatives = std::map<std::string, Trace>;

// The reference's outputs for the inputs of `law`, on every other branch that the case allows;
// `law` has the outputs on the law's own branch. Errors: the integrals differ between the branches,
// so that the choice affects later ticks; the branches have the same outputs at all ticks; the
// profile is unknown.
Result<BranchAlternatives> branch_alternatives(const Case& the_case, const Trace& law);

// A copy of `law`, in which each tick has the outputs of the branch that `got` agrees with; the
// law's own branch comes first. If `got` agrees with no branch, the tolerances are multiplied by 10
// until it does. If it does not with 1e4 times the tolerances, the law's own branch stays.
// REQUIRES: the same number of samples in all.
Trace on_the_branch_of(const Trace& got, const Trace& law, const BranchAlternatives& others,
                       const Tolerances& tolerances);

}  // namespace attest
