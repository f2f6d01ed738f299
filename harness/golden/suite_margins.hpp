// How near the numeric vectors of a suite come to the decisions of the law.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/golden/margins.hpp"

namespace attest {

// Of which vector a margin is, and at which tick.
struct VectorMargin {
  const Case* the_case = nullptr;  // null: no vector comes to that decision
  RunConfiguration configuration{};
  Decision decision{};
  Margin margin{};
};

struct SuiteMargins {
  std::size_t vectors = 0;
  std::array<VectorMargin, decision_count> nearest{};  // by decision
  std::vector<VectorMargin> too_near;                  // in the order of the cases
};

// Of the open-loop cases that are not for the exact level only, at each of their rates. Decisions
// that a case stands on (Case::either_branch) are left out. Valid as long as `cases` is.
SuiteMargins suite_margins(const std::vector<SelectedCase>& cases);

}  // namespace attest
