// The margins of a suite's vectors (cases at one rate): their distances from the decisions of the
// law.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
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

// The vectors of a profile that are nearest to a decision.
struct Approach {
  VectorMargin on;            // among those for the exact level only
  VectorMargin below, above;  // among the numeric ones, on each side

  const VectorMargin& at(Place place) const {
    return place == Place::on ? on : place == Place::below ? below : above;
  }
  // Whether a vector of the profile reaches the decision at all. If not, its law does not have it.
  bool is_reached() const;
  // Whether a vector is there: within on_threshold() or near_margins. REQUIRES: the decision of
  // this Approach.
  bool has(Decision decision, Place place) const;
};

struct SuiteMargins {
  std::size_t vectors = 0;                             // numeric vectors that were measured
  std::size_t not_measured = 0;                        // numeric vectors without a MarginMeter
  std::array<VectorMargin, decision_count> nearest{};  // of numeric vectors, by decision
  std::vector<VectorMargin> too_near;                  // unsafe; in the order of the cases
  // By profile and decision, without the laws alone: a port of a unit does not run their cases.
  std::map<std::string, std::array<Approach, decision_count>> approaches;
};

// Measures the selected open-loop cases. The result is valid as long as `cases`.
SuiteMargins suite_margins(const std::vector<SelectedCase>& cases);

}  // namespace attest
