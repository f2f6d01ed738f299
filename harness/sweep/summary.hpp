// The results of a sweep, computed from the table of its samples.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/sweep/sample_table.hpp"
#include "harness/sweep/sobol_indices.hpp"
#include "harness/sweep/statistics.hpp"
#include "harness/sweep/sweep_file.hpp"

namespace attest {

// Whether the flights show, with the confidence of the file, that a requirement is met.
enum class RequirementDecision { met, not_met, undecided };
std::string_view name_of(RequirementDecision decision);  // "not met"

struct RequirementResult {
  Requirement requirement;
  std::uint64_t held = 0;  // flights that hold it, all with the outcome `done`
  std::uint64_t count = 0;
  // With the confidence of the file. A grid is not random: both ends are the share of its flights
  // that hold the requirement. A sweep that may end early has a sequential interval.
  Interval probability;
  RequirementDecision decision = RequirementDecision::undecided;
  std::vector<std::uint64_t> worst;  // samples, the worst first
};

// A metric over the flights that were done. Percentiles are empty where there are too few flights
// (supports_percentile()).
struct MetricSummary {
  std::string name;
  std::uint64_t count = 0;
  double min = 0, median = 0, max = 0;
  std::optional<double> p95, p99;
  std::vector<double> correlation;    // rank correlation with each dispersion; NaN: none
  std::optional<SobolIndices> sobol;  // of the design `saltelli`, of SweepSummary::dimensions
};

// Port minus reference on the same samples, where both were done.
struct MetricDifference {
  std::string name;
  std::uint64_t count = 0;
  std::uint64_t above = 0, below = 0;  // beyond the tie of the file
  double median = 0;
  std::optional<double> p1, p99;
  double p_value = 1;  // of the sign test; the sequential one if the sweep may end early
  bool differs = false;
};

struct PortDifference {
  std::vector<MetricDifference> metrics;
  // Flights that only one of the two lost.
  std::uint64_t lost_by_port = 0, lost_by_reference = 0;
  double p_value = 1;
  bool losses_differ = false;  // the sign test finds that the port loses more, or fewer, flights
  std::uint64_t pairs_needed = 0;  // with fewer pairs of flights no test can find a difference

  bool differs() const;
  // Every metric has enough pairs. A sample with a flight that was lost is not a pair.
  bool is_comparison() const;
};

struct SweepSummary {
  std::uint64_t samples = 0;
  std::uint64_t planned = 0;  // more than `samples`: all requirements were decided before
  // The number of flights by outcome: of the port if there is one, else of the reference.
  std::map<std::string, std::uint64_t> outcomes;
  std::vector<RequirementResult> requirements;
  std::vector<MetricSummary> metrics;
  std::vector<std::string> dimensions;  // the dispersions that are no seeds
  std::optional<PortDifference> port;

  // At least one flight was done, and all requirements are met. The port has no fault, was compared
  // with the reference, and does not differ from it.
  bool passes() const;
};

// `worst`: the number of worst samples to name for each requirement.
SweepSummary summarise(const SweepFile& sweep, const SampleColumns& columns, const SampleData& data,
                       std::size_t worst);

}  // namespace attest
