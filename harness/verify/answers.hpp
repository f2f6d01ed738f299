// What a unit answered at each tick of a flight, beside what the reference answers to the same
// inputs. The plant is out of it: a difference does not grow by coming back as an input, and the
// first tick that is wrong is the one at which the port erred.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "harness/compare/compare.hpp"
#include "harness/core/result.hpp"
#include "harness/golden/margins.hpp"

namespace attest {

struct Answers {
  // Of the ticks before `undecided`, or of all.
  Comparison comparison;

  // The first tick at which the law is so near a decision (margins.hpp) that rounding makes it, if
  // an answer deviates there or later: it depends on which way a right port went.
  struct Undecided {
    Decision decision;
    std::size_t tick;
    std::size_t deviating_tick;
  };
  std::optional<Undecided> undecided;
};

// A unit of the reference is given the inputs of `flown`, from its power-on state on, and each tick
// is compared. A NaN or infinity where the reference has a number is never undecided.
// `fraction_bits`: of a port in fixed point, which rounds more. REQUIRES: a whole trace of a unit,
// which has at least a tick. Errors: the reference does not have the profile, or fails.
Result<Answers> compare_answers(const Trace& flown, const std::string& profile,
                                const Tolerances& tolerances,
                                std::optional<int> fraction_bits = {});

}  // namespace attest
