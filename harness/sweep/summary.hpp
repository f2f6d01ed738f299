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
  std::uint64_t held = 0;   // flights that hold it, all with the outcome `done`
  std::uint64_t count = 0;  // flights that were judged
  // The interval for the probability that a flight holds the requirement, with the confidence of
  // the file. A sweep with `stop_when_decided` has a sequential interval. A grid is not random:
  // both ends are the share of its flights that hold the requirement.
  Interval probability;
  RequirementDecision decision = RequirementDecision::undecided;
  std::vector<std::uint64_t> worst;  // indices of the worst samples, the worst first
};

// A metric over the flights that were done: of the port if there is one, else of the reference.
// Percentiles are empty if there are too few flights (supports_percentile()).
struct MetricSummary {
  std::string name;
  std::uint64_t count = 0;
  double min = 0, median = 0, max = 0;
  std::optional<double> p95, p99;
  std::vector<double> correlation;    // rank_correlation() with each dispersion
  std::optional<SobolIndices> sobol;  // of each of SweepSummary::dimensions; design `saltelli` only
};

// Port minus reference on the samples that both have done, without mixed points
// (Design::is_judged).
struct MetricDifference {
  std::string name;
  std::uint64_t count = 0;
  std::uint64_t above = 0, below = 0;  // differences beyond the tie (SweepFile::tie)
  double median = 0;
  std::optional<double> p1, p99;
  double p_value = 1;  // of the sign test; with `stop_when_decided` of the sequential one
  bool differs = false;
};

struct PortDifference {
  std::vector<MetricDifference> metrics;
  // Lost flights, whose outcome is not `done`: samples that only the port, or only the reference,
  // lost.
  std::uint64_t lost_by_port = 0, lost_by_reference = 0;
  double p_value = 1;          // of the sign test of these two numbers
  bool losses_differ = false;  // the sign test finds that the port loses more, or fewer, flights
  std::uint64_t pairs_needed = 0;  // with fewer pairs of flights no test can find a difference

  bool differs() const;
  // Every metric has enough pairs for a test. A sample that port or reference lost is no pair.
  bool is_comparison() const;
};

struct SweepSummary {
  std::uint64_t samples = 0;
  std::uint64_t planned = 0;  // more than `samples` if the sweep ended early
  // The number of flights by outcome: of the port if there is one, else of the reference.
  std::map<std::string, std::uint64_t> outcomes;
  std::vector<RequirementResult> requirements;
  std::vector<MetricSummary> metrics;
  std::vector<std::string> dimensions;  // the dispersions except seeds
  std::optional<PortDifference> port;

  // At least one flight was done, no outcome is a fault, and all requirements are met. If there is
  // a port, it was compared with the reference (is_comparison()) and does not differ from it.
  bool passes() const;
};

// `worst`: the number of worst samples to name for each requirement.
SweepSummary summarise(const SweepFile& sweep, const SampleColumns& columns, const SampleData& data,
                       std::size_t worst);

}  // namespace attest
