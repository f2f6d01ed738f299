#include "harness/sweep/compare_pilots.hpp"

#include <algorithm>
#include <cmath>

#include "harness/sweep/sequential.hpp"
#include "harness/sweep/statistics.hpp"

namespace attest {
namespace {

double sign_test_of(const SweepFile& sweep, std::uint64_t above, std::uint64_t below) {
  return sweep.stop_when_decided ? sequential_sign_test(above, below) : sign_test(above, below);
}

// Bonferroni: there is a test for each metric, and one for lost flights. If port and reference fly
// equally, the probability that any of these tests finds a difference is at most 1 - confidence.
double significance(const SweepFile& sweep, std::size_t metrics) {
  return (1 - sweep.confidence) / static_cast<double>(metrics + 1);
}

double median_size(std::vector<double> values) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return 0;
  for (double& value : values) value = std::abs(value);
  std::sort(values.begin(), values.end());
  return empirical_quantile(values, 0.5);
}

// The sign test ignores differences within the tie, such as those by another order of arithmetic.
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
  difference.p1 = supported_quantile(sorted, 0.01);
  difference.p99 = supported_quantile(sorted, 0.99);
  return difference;
}

}  // namespace

std::uint64_t pairs_to_compare(const SweepFile& sweep, std::size_t metrics) {
  std::uint64_t pairs = 1;
  while (sign_test_of(sweep, pairs, 0) >= significance(sweep, metrics)) ++pairs;
  return pairs;
}

PortDifference compare_pilots(const SweepFile& sweep, const SampleColumns& columns,
                              const PilotData& reference, const PilotData& port) {
  PortDifference result;
  result.pairs_needed = pairs_to_compare(sweep, columns.metrics.size());
  for (std::size_t i = 0; i < reference.outcomes.size(); ++i) {
    if (!sweep.design.is_judged(i)) continue;
    const bool by_reference = reference.outcomes[i] != outcome_done;
    const bool by_port = port.outcomes[i] != outcome_done;
    if (by_port && !by_reference) ++result.lost_by_port;
    if (by_reference && !by_port) ++result.lost_by_reference;
  }
  result.p_value = sign_test_of(sweep, result.lost_by_port, result.lost_by_reference);
  const double significant = significance(sweep, columns.metrics.size());
  result.losses_differ = result.p_value < significant;
  for (std::size_t i = 0; i < columns.metrics.size(); ++i) {
    MetricDifference one =
        difference_of(columns.metrics[i], reference.metrics[i], port.metrics[i], sweep);
    one.differs = one.p_value < significant;
    result.metrics.push_back(std::move(one));
  }
  return result;
}

bool PortDifference::is_comparison() const {
  return std::all_of(metrics.begin(), metrics.end(),
                     [this](const MetricDifference& one) { return one.count >= pairs_needed; });
}

bool PortDifference::differs() const {
  return losses_differ || std::any_of(metrics.begin(), metrics.end(),
                                      [](const MetricDifference& one) { return one.differs; });
}

}  // namespace attest
