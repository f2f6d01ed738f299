#include "harness/sweep/requirement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "harness/sweep/sequential.hpp"

namespace attest {
namespace {

// The distance beyond the nearer bound; below 0 within the bounds. Infinite without a value.
double violation(const Requirement& requirement, double value) {
  if (std::isnan(value)) return std::numeric_limits<double>::infinity();
  return std::max(value - requirement.max, requirement.min - value);
}

std::vector<std::uint64_t> worst_samples(const Requirement& requirement,
                                         const std::vector<double>& values, std::size_t count) {
  std::vector<std::pair<double, std::uint64_t>> order;
  for (std::size_t i = 0; i < values.size(); ++i) {
    order.emplace_back(-violation(requirement, values[i]), i);
  }
  const auto end = order.begin() + static_cast<std::ptrdiff_t>(std::min(count, order.size()));
  std::partial_sort(order.begin(), end, order.end());
  std::vector<std::uint64_t> samples;
  for (auto it = order.begin(); it != end; ++it) samples.push_back(it->second);
  return samples;
}

// Uses the same rule as EarlyStop.
RequirementDecision decided_sequentially(const RequirementResult& result, double confidence) {
  const double needed = result.requirement.probability;
  if (!excludes(result.held, result.count, needed, confidence))
    return RequirementDecision::undecided;
  const double share = static_cast<double>(result.held) / static_cast<double>(result.count);
  return share >= needed ? RequirementDecision::met : RequirementDecision::not_met;
}

RequirementDecision decided(const Interval& interval, double probability) {
  if (interval.low >= probability) return RequirementDecision::met;
  return interval.high < probability ? RequirementDecision::not_met
                                     : RequirementDecision::undecided;
}

}  // namespace

RequirementResult judge_requirement(const Requirement& requirement, const PilotData& flights,
                                    std::size_t metric, const SweepFile& sweep, std::size_t worst) {
  RequirementResult result;
  result.requirement = requirement;
  const std::vector<double>& values = flights.metrics[metric];
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!sweep.design.is_judged(i)) continue;
    ++result.count;
    if (requirement.holds(values[i])) ++result.held;
  }
  result.worst = worst_samples(requirement, values, worst);
  if (sweep.stop_when_decided) {
    result.probability = sequential_interval(result.held, result.count, sweep.confidence);
    result.decision = decided_sequentially(result, sweep.confidence);
    return result;
  }
  if (sweep.design.kind == DesignKind::grid) {
    const double share = static_cast<double>(result.held) / static_cast<double>(result.count);
    result.probability = {share, share};
  } else {
    result.probability = clopper_pearson(result.held, result.count, sweep.confidence);
  }
  result.decision = decided(result.probability, requirement.probability);
  return result;
}

}  // namespace attest
