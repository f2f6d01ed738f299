// What a unit answered at each tick of a flight, beside what the reference answers to the same
// inputs. The plant is out of it: a difference does not grow by coming back as an input, and the
// first tick that is wrong is the one at which the port erred.
#pragma once

#include <optional>
#include <string>

#include "harness/compare/compare.hpp"

namespace attest {

// A unit of the reference is given the inputs of `flown`, from its power-on state on, and each tick
// is compared. The comparison ends before the first tick at which the law is so near a decision
// (margins.hpp) that rounding makes it: what follows depends on which way a right port went.
// `ticks` of the result says how far it went. `fraction_bits`: of a port in fixed point, which
// rounds more. REQUIRES: a whole trace of a unit, of a profile that the reference has.
Comparison compare_answers(const Trace& flown, const std::string& profile,
                           const Tolerances& tolerances, std::optional<int> fraction_bits = {});

}  // namespace attest
