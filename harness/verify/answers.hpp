// Compares the outputs of a unit at each tick of a flight with those of the reference for the same
// inputs. The plant has no part in this, so a difference cannot grow through feedback. The first
// deviating tick is therefore the tick at which the port erred.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "harness/compare/compare.hpp"
#include "harness/core/result.hpp"
#include "harness/golden/margins.hpp"

namespace attest {

struct Answers {
  // Of the ticks before `undecided`, or of all ticks.
  Comparison comparison;

  // The first tick at which rounding makes a decision of the law (margins.hpp). Set if an output
  // deviates there or later: correct outputs then depend on the branch that the port took.
  struct Undecided {
    Decision decision;
    std::size_t tick;
    std::size_t deviating_tick;
  };
  std::optional<Undecided> undecided;
};

// A unit of the reference, from its power-on state on, gets the inputs of `flown`, and each tick is
// compared. A NaN or infinity where the reference has a number is never undecided. `fraction_bits`:
// of a port in fixed point, which rounds more. REQUIRES: a whole trace of a unit, with at least one
// tick. Errors: the reference does not have the profile, or fails.
Result<Answers> compare_answers(const Trace& flown, const std::string& profile,
                                const Tolerances& tolerances,
                                std::optional<int> fraction_bits = {});

}  // namespace attest
