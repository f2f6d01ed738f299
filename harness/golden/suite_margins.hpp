// The margins of a suite's numeric vectors (cases that are compared with a tolerance, at one rate):
// their distances from the decisions of the law.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "harness/casefile/select.hpp"
#include "harness/golden/margins.hpp"

namespace attest {

struct VectorMargin {
  const Case* the_case = nullptr;  // null: no vector reaches that decision
  RunConfiguration configuration{};
  Decision decision{};
  Margin margin{};
};

struct SuiteMargins {
  std::size_t vectors = 0;                             // measured
  std::size_t not_measured = 0;                        // numeric vectors without a MarginMeter
  std::array<VectorMargin, decision_count> nearest{};  // by decision
  std::vector<VectorMargin> too_near;                  // unsafe; in the order of the cases
};

// Measures the selected open-loop cases, without those for the exact level only. The result is
// valid as long as `cases`.
SuiteMargins suite_margins(const std::vector<SelectedCase>& cases);

}  // namespace attest
