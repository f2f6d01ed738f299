// The margins of the numeric vectors of a suite: their distances from the decisions of the law.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/golden/margins.hpp"

namespace attest {

// A margin, with its vector and tick.
struct VectorMargin {
  const Case* the_case = nullptr;  // null: no vector reaches that decision
  RunConfiguration configuration{};
  Decision decision{};
  Margin margin{};
};

struct SuiteMargins {
  std::size_t vectors = 0;
  std::size_t not_measured = 0;                        // numeric vectors without a MarginMeter
  std::array<VectorMargin, decision_count> nearest{};  // by decision
  std::vector<VectorMargin> too_near;                  // in the order of the cases
};

// Of the open-loop cases that are not for the exact level only, at each of their rates. Decisions
// at which a case is at a tie on purpose (Case::either_branch) are left out. Valid as long as
// `cases` is.
SuiteMargins suite_margins(const std::vector<SelectedCase>& cases);

}  // namespace attest
