// Compares the outputs of a unit at each tick of a flight with those of the reference for the same
// inputs. A difference cannot grow through the plant, so the first deviating tick is the tick at
// which the port erred.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "harness/compare/compare.hpp"
#include "harness/core/result.hpp"
#include "harness/golden/margins.hpp"
#include "harness/loop/flight.hpp"

namespace attest {

struct ReferenceComparison {
  // Of the ticks before Undecided::tick if `undecided` is set, otherwise of all ticks. If all ticks
  // agree, `tightest` is still that of the ticks before the first decision by rounding.
  Comparison comparison;

  // The first tick at which rounding can make a decision of the law (decisions.hpp). Set if the
  // outputs agree before this tick and deviate at it or later. Correct outputs then depend on the
  // branch that the port took.
  struct Undecided {
    Decision decision;
    std::size_t tick;
    std::size_t deviating_tick;
  };
  std::optional<Undecided> undecided;
};

// Gives the inputs of `flown` to a unit of the reference in its power-on state, and compares each
// tick. A NaN or infinity where the reference has a number is never undecided, and neither is a
// deviation at the level exact, where ports round as the reference does. `fraction_bits` is
// set for a port in fixed point, which rounds more. REQUIRES: `flown` is the whole trace of a unit,
// with at least one tick. Errors: the reference does not have the profile, or fails.
Result<ReferenceComparison> compare_with_reference(const Trace& flown, const std::string& profile,
                                                   const Tolerances& tolerances,
                                                   std::optional<int> fraction_bits = {});

// The same of a flight, which has a trace of each of its units.
Result<Comparison> compare_with_reference(const Flown& flown, const std::string& profile,
                                          const Tolerances& tolerances,
                                          std::optional<int> fraction_bits);

// The first tick, up to `last_tick`, at which a port can make a decision of the law by rounding;
// with `fraction_bits`, a port in fixed point. Empty if there is none, or if no margins are known
// (margin_meter).
struct NearDecision {
  Decision decision;
  std::size_t tick;
};
std::optional<NearDecision> first_near_decision(const ModuleUnderTest& subject, const Trace& given,
                                                std::optional<int> fraction_bits,
                                                std::size_t last_tick);

}  // namespace attest
