#include "harness/golden/suite_margins.hpp"

#include "harness/casefile/stimulus.hpp"

namespace attest {
namespace {

void keep_nearer(VectorMargin& nearest, const VectorMargin& one) {
  if (is_nearer(one.decision, one.margin, nearest.margin)) nearest = one;
}

void add(const Case& the_case, const RunConfiguration& configuration, SuiteMargins& all) {
  const ModuleUnderTest subject = subject_of(the_case);
  const auto meter = margin_meter(subject);
  if (!meter) {
    if (!the_case.exact_only) ++all.not_measured;
    return;
  }
  const Margins found = margins(stimulate(the_case, configuration.rate.motor_unit), *meter);
  if (!the_case.exact_only) ++all.vectors;
  for (std::size_t i = 0; i < decision_count; ++i) {
    const auto decision = static_cast<Decision>(i);
    const auto vector = [&](const Margin& margin) {
      return VectorMargin{&the_case, configuration, decision, margin};
    };
    if (!the_case.exact_only) {
      keep_nearer(all.nearest[i], vector(found[decision]));
      if (!found.is_safe(decision)) all.too_near.push_back(vector(found[decision]));
    }
    if (info_of(subject.module).is_law()) continue;
    Approach& approach = all.approaches[the_case.profile][i];
    if (the_case.exact_only) {
      keep_nearer(approach.on, vector(found[decision]));
    } else {
      keep_nearer(approach.below, vector(found.at(decision, Side::below)));
      keep_nearer(approach.above, vector(found.at(decision, Side::above)));
    }
  }
}

}  // namespace

bool Approach::is_reached() const {
  return on.margin.is_measured() || below.margin.is_measured() || above.margin.is_measured();
}

bool Approach::has(Decision decision, Place place) const {
  const double most =
      place == Place::on ? on_threshold(decision) : near_margins * least_margin(decision);
  return at(place).margin.distance <= most;
}

SuiteMargins suite_margins(const std::vector<SelectedCase>& cases) {
  SuiteMargins all;
  for (const auto& [the_case, configurations] : cases) {
    if (the_case.flight) continue;
    for (const RunConfiguration& configuration : configurations) add(the_case, configuration, all);
  }
  return all;
}

}  // namespace attest
