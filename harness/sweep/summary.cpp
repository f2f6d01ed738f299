#include "harness/sweep/summary.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "harness/realtime/histogram.hpp"
#include "harness/sweep/parse_dispersions.hpp"
#include "harness/sweep/requirement.hpp"
#include "harness/sweep/sequential.hpp"

namespace attest {
namespace {

// Empty where fewer than ten values are beyond the percentile.
std::optional<double> percentile(const std::vector<double>& sorted, double part) {
  if (!supports_percentile(sorted.size(), std::max(part, 1 - part))) return std::nullopt;
  return empirical_quantile(sorted, part);
}

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
    summary.p95 = percentile(sorted, 0.95);
    summary.p99 = percentile(sorted, 0.99);
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

double sign_test_of(const SweepFile& sweep, std::uint64_t above, std::uint64_t below) {
  return sweep.stop_when_decided ? sequential_sign_test(above, below) : sign_test(above, below);
}

double median_size(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return 0;
  for (double& value : values) value = std::abs(value);
  std::sort(values.begin(), values.end());
  return empirical_quantile(values, 0.5);
}

// The sign test ignores differences within the tie: those of another order of arithmetic.
MetricDifference difference_of(const std::string& name, const std::vector<double>& reference,
                               const std::vector<double>& port, const SweepFile& sweep) {
  MetricDifference difference;
  difference.name = name;
  const double usual = median_size(reference);
  std::vector<double> sorted;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    if (std::isnan(reference[i]) || std::isnan(port[i]) || !sweep.design.is_judged(i)) continue;
    const double one = reference[i] == port[i] ? 0 : port[i] - reference[i];
    sorted.push_back(one);
    const double scale = std::isfinite(reference[i]) ? std::abs(reference[i]) : 0;
    const double allowed = sweep.tie * std::max(scale, usual);
    if (one > allowed) ++difference.above;
    if (one < -allowed) ++difference.below;
  }
  difference.count = sorted.size();
  difference.p_value = sign_test_of(sweep, difference.above, difference.below);
  if (sorted.empty()) return difference;
  std::sort(sorted.begin(), sorted.end());
  difference.median = empirical_quantile(sorted, 0.5);
  difference.p1 = percentile(sorted, 0.01);
  difference.p99 = percentile(sorted, 0.99);
  return difference;
}

PortDifference compare_pilots(const SweepFile& sweep, const SampleColumns& columns,
                              const PilotData& reference, const PilotData& port) {
  PortDifference result;
  for (std::size_t i = 0; i < reference.outcomes.size(); ++i) {
    if (!sweep.design.is_judged(i)) continue;
    const bool by_reference = reference.outcomes[i] != outcome_done;
    const bool by_port = port.outcomes[i] != outcome_done;
    if (by_port && !by_reference) ++result.lost_by_port;
    if (by_reference && !by_port) ++result.lost_by_reference;
  }
  result.p_value = sign_test_of(sweep, result.lost_by_port, result.lost_by_reference);
  // Bonferroni: all tests together are wrong with at most the probability 1 - confidence.
  const double tests = static_cast<double>(columns.metrics.size() + 1);
  const double significant = (1 - sweep.confidence) / tests;
  result.losses_differ = result.p_value < significant;
  for (std::size_t i = 0; i < columns.metrics.size(); ++i) {
    MetricDifference one =
        difference_of(columns.metrics[i], reference.metrics[i], port.metrics[i], sweep);
    one.differs = one.p_value < significant;
    result.metrics.push_back(std::move(one));
  }
  return result;
}

}  // namespace

std::string_view name_of(RequirementVerdict decision) {
  switch (decision) {
    case RequirementVerdict::met:
      return "met";
    case RequirementVerdict::not_met:
      return "not met";
    case RequirementVerdict::undecided:
      return "undecided";
  }
  return "";
}

bool PortDifference::differs() const {
  return losses_differ || std::any_of(metrics.begin(), metrics.end(),
                                      [](const MetricDifference& one) { return one.differs; });
}

bool SweepSummary::passes() const {
  const bool met = std::all_of(
      requirements.begin(), requirements.end(),
      [](const RequirementResult& one) { return one.decision == RequirementVerdict::met; });
  const bool faultless = std::all_of(outcomes.begin(), outcomes.end(), [](const auto& outcome) {
    return outcome.first == outcome_done || outcome.first == outcome_diverged;
  });
  return met && faultless && !(port && port->differs());
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
