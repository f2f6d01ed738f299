#include "harness/sweep/summary.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "harness/sweep/compare_pilots.hpp"
#include "harness/sweep/parse_dispersions.hpp"
#include "harness/sweep/requirement.hpp"

namespace attest {
namespace {

MetricSummary summary_of(const SweepFile& sweep, const std::string& name,
                         const std::vector<double>& values, const SampleData& data) {
  MetricSummary summary;
  summary.name = name;
  std::vector<double> sorted;
  std::copy_if(values.begin(), values.end(), std::back_inserter(sorted),
               [](double value) { return !std::isnan(value); });
  std::sort(sorted.begin(), sorted.end());
  summary.count = sorted.size();
  if (!sorted.empty()) {
    summary.min = sorted.front();
    summary.median = empirical_quantile(sorted, 0.5);
    summary.p95 = supported_quantile(sorted, 0.95);
    summary.p99 = supported_quantile(sorted, 0.99);
    summary.max = sorted.back();
  }
  for (const std::vector<double>& drawn : data.drawn) {
    summary.correlation.push_back(rank_correlation(drawn, values));
  }
  if (sweep.design.kind == DesignKind::saltelli) {
    summary.sobol = sobol_indices(values, sweep.design.dimensions, sweep.confidence);
  }
  return summary;
}

}  // namespace

std::string_view name_of(RequirementDecision decision) {
  switch (decision) {
    case RequirementDecision::met:
      return "met";
    case RequirementDecision::not_met:
      return "not met";
    case RequirementDecision::undecided:
      return "undecided";
  }
  return "";
}

bool SweepSummary::passes() const {
  const bool any_done = outcomes.contains(outcome_done);
  const bool met = std::all_of(
      requirements.begin(), requirements.end(),
      [](const RequirementResult& one) { return one.decision == RequirementDecision::met; });
  const bool faultless = std::all_of(outcomes.begin(), outcomes.end(), [](const auto& outcome) {
    return outcome.first == outcome_done || outcome.first == outcome_diverged;
  });
  return any_done && met && faultless && !(port && (port->differs() || !port->is_comparison()));
}

SweepSummary summarise(const SweepFile& sweep, const SampleColumns& columns, const SampleData& data,
                       std::size_t worst) {
  SweepSummary summary;
  summary.samples = data.samples();
  summary.planned = sweep.design.samples;
  const PilotData& judged = data.pilots.back();
  for (const std::string& outcome : judged.outcomes) ++summary.outcomes[outcome];
  for (const Requirement& requirement : sweep.requirements) {
    summary.requirements.push_back(
        judge_requirement(requirement, judged, columns.place_of(requirement.metric), sweep, worst));
  }
  for (std::size_t i = 0; i < columns.metrics.size(); ++i) {
    summary.metrics.push_back(summary_of(sweep, columns.metrics[i], judged.metrics[i], data));
  }
  for (const std::size_t i : dimensions_of(sweep.dispersions)) {
    summary.dimensions.push_back(sweep.dispersions[i].name);
  }
  if (columns.with_port) {
    summary.port = compare_pilots(sweep, columns, data.pilots.front(), data.pilots.back());
  }
  return summary;
}

}  // namespace attest
