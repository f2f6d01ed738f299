#include "harness/golden/suite_margins.hpp"

#include "harness/casefile/stimulus.hpp"

namespace attest {
namespace {

void add(const Case& the_case, const RunConfiguration& configuration, SuiteMargins& all) {
  const auto meter = margin_meter(subject_of(the_case));
  if (!meter) {
    ++all.not_measured;
    return;
  }
  const Margins found = margins(stimulate(the_case, configuration.rate.motor_unit), *meter);
  ++all.vectors;
  for (std::size_t i = 0; i < decision_count; ++i) {
    const auto decision = static_cast<Decision>(i);
    const VectorMargin one{&the_case, configuration, decision, found[decision]};
    if (is_nearer(decision, one.margin, all.nearest[i].margin)) all.nearest[i] = one;
    if (!found.is_safe(decision)) all.too_near.push_back(one);
  }
}

}  // namespace

SuiteMargins suite_margins(const std::vector<SelectedCase>& cases) {
  SuiteMargins all;
  for (const auto& [the_case, configurations] : cases) {
    if (the_case.flight || the_case.exact_only) continue;
    for (const RunConfiguration& configuration : configurations) add(the_case, configuration, all);
  }
  return all;
}

}  // namespace attest
