#include "harness/report/sweep_summary_text.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/report/failure_text.hpp"
#include "harness/report/text.hpp"
#include "harness/sweep/keep_flights.hpp"

namespace attest {
namespace {

std::string number(double value) { return fmt::format("{:.4g}", value); }
std::string number(const std::optional<double>& value) { return value ? number(*value) : "-"; }

std::string requirements_of(const SweepFile& sweep, const SweepSummary& summary) {
  if (summary.requirements.empty()) return "";
  std::string out =
      fmt::format("\n{:<16}{:<16}{:<18}{:>12}  {:<20}{:<10}{}\n", "requirement", "metric", "bounds",
                  "held", probability_heading(sweep), "needed", "decision");
  for (const RequirementResult& one : summary.requirements) {
    out += fmt::format("{:<16}{:<16}{:<18}{:>12}  {:<20}{:<10}{}\n", one.requirement.name,
                       one.requirement.metric, bounds_of(one.requirement),
                       fmt::format("{}/{}", one.held, one.count), probability_of(sweep, one),
                       fmt::format("{:g}", one.requirement.probability), name_of(one.decision));
  }
  return out;
}

std::string metrics_of(const SweepSummary& summary) {
  std::string out = fmt::format("\n{:<16}{:>8}{:>11}{:>11}{:>11}{:>11}{:>11}\n", "metric",
                                "flights", "min", "median", "p95", "p99", "max");
  for (const MetricSummary& one : summary.metrics) {
    out += fmt::format("{:<16}{:>8}", one.name, one.count);
    if (one.count == 0) {
      out += "\n";
      continue;
    }
    out += fmt::format("{:>11}{:>11}{:>11}{:>11}{:>11}\n", number(one.min), number(one.median),
                       number(one.p95), number(one.p99), number(one.max));
  }
  return out;
}

std::string sensitivity_of(const SampleColumns& columns, const SweepSummary& summary) {
  std::string out = fmt::format("\n{:<24}", "rank correlation with");
  for (const std::string& name : columns.metrics) out += fmt::format(" {:>12}", name);
  out += "\n";
  for (std::size_t d = 0; d < columns.dispersions.size(); ++d) {
    out += fmt::format("{:<24}", columns.dispersions[d]);
    for (const MetricSummary& one : summary.metrics) {
      const double correlation = one.correlation[d];
      out += fmt::format(" {:>12}",
                         std::isnan(correlation) ? "-" : fmt::format("{:+.2f}", correlation));
    }
    out += "\n";
  }
  return out;
}

std::string indices_of(const SweepFile& sweep, const SweepSummary& summary) {
  std::string out;
  for (const MetricSummary& metric : summary.metrics) {
    if (!metric.sobol) continue;
    out += fmt::format("\n{}\n{:<24}{:>26}{:>26}\n", indices_heading(sweep, metric), "dispersion",
                       "first order", "total");
    for (std::size_t i = 0; i < metric.sobol->dimensions.size(); ++i) {
      const SobolIndex& one = metric.sobol->dimensions[i];
      out += fmt::format("{:<24}{:>26}{:>26}\n", summary.dimensions[i],
                         index_text(one.first, one.first_interval),
                         index_text(one.total, one.total_interval));
    }
  }
  return out;
}

std::string difference_of(const SweepFile& sweep, const PortDifference& port) {
  std::string out = fmt::format(
      "\nport minus reference on the same samples; above, below: flights that differ by more than "
      "{:g} of the reference's value\n{:<16}{:>8}{:>8}{:>8}{:>12}{:>12}{:>12}{:>14}\n",
      sweep.tie, "metric", "flights", "above", "below", "median", "p1", "p99", "sign test p");
  for (const MetricDifference& one : port.metrics) {
    out += fmt::format("{:<16}{:>8}{:>8}{:>8}{:>12}{:>12}{:>12}{:>14}{}\n", one.name, one.count,
                       one.above, one.below, number(one.median), number(one.p1), number(one.p99),
                       fmt::format("{:.2g}", one.p_value), one.differs ? "  differs" : "");
  }
  out += fmt::format("lost by the port only: {}, by the reference only: {}, sign test p {:.2g}{}\n",
                     port.lost_by_port, port.lost_by_reference, port.p_value,
                     port.losses_differ ? "  differs" : "");
  return out + difference_text(port) + "\n";
}

std::string worst_of(const FlightSampler& sampler, const SweepSummary& summary,
                     const std::string& port, const std::filesystem::path& kept) {
  std::string out;
  for (const RequirementResult& one : summary.requirements) {
    if (one.worst.empty()) continue;
    out += fmt::format("\nworst flights for {}:\n", one.requirement.name);
    for (const std::uint64_t sample : one.worst) {
      out += "  " + sim_command_for(sampler, sample, port, kept) + "\n";
    }
  }
  return out;
}

}  // namespace

std::string heading_of(const FlightSampler& sampler, const SweepSummary& summary) {
  const SweepFile& sweep = sampler.sweep();
  const RunConfiguration configuration{sweep.rate, sampler.nominal().plant_configuration};
  const bool ended_early = summary.samples < summary.planned;
  return fmt::format("{}: {}{} samples, design {}", sampler.nominal().the_case.id_at(configuration),
                     summary.samples, ended_early ? fmt::format(" of {}", summary.planned) : "",
                     name_of(sweep.design.kind));
}

std::string ending_of(const SweepFile& sweep, const SweepSummary& summary) {
  if (!sweep.stop_when_decided) return "";
  const auto& all = summary.requirements;
  const bool is_decided = std::all_of(all.begin(), all.end(), [](const RequirementResult& one) {
    return one.decision != RequirementDecision::undecided;
  });
  return fmt::format(
      "{}; intervals and tests are sequential: valid although the sweep may end early",
      is_decided ? "Ended because every requirement is decided"
                 : "Flew all samples, and not every requirement is decided");
}

std::string outcomes_of(const SweepSummary& summary) {
  std::vector<std::string> outcomes;
  for (const auto& [outcome, count] : summary.outcomes) {
    outcomes.push_back(fmt::format("{} {}", count, outcome));
  }
  return fmt::format("{}", fmt::join(outcomes, ", "));
}

std::string bounds_of(const Requirement& requirement) {
  MetricResult bounds;
  bounds.min = requirement.min;
  bounds.max = requirement.max;
  return metric_bounds(bounds);
}

std::string probability_heading(const SweepFile& sweep) {
  if (sweep.design.kind == DesignKind::grid) return "share";
  return fmt::format("probability ({:g})", sweep.confidence);
}

std::string probability_of(const SweepFile& sweep, const RequirementResult& result) {
  const auto [low, high] = result.probability;
  if (sweep.design.kind == DesignKind::grid) return fmt::format("{:.4f}", low);
  return fmt::format("{:.4f} to {:.4f}", low, high);
}

std::string index_text(double value, const Interval& interval) {
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", value, interval.low, interval.high);
}

std::string indices_heading(const SweepFile& sweep, const MetricSummary& metric) {
  const SobolIndices& sobol = *metric.sobol;
  std::string heading = fmt::format("Sobol indices of {}, of {} blocks ({:g})", metric.name,
                                    sobol.blocks, sweep.confidence);
  if (sobol.left_out > 0) {
    heading +=
        fmt::format("; {} blocks left out, because a flight has no finite value", sobol.left_out);
  }
  if (sobol.dimensions.empty()) heading += "; too few blocks, or the metric does not vary";
  return heading;
}

std::string difference_text(const PortDifference& port) {
  std::vector<std::string> where;
  if (port.losses_differ) where.emplace_back("the number of flights that are lost");
  for (const MetricDifference& one : port.metrics) {
    if (one.differs) where.push_back(one.name);
  }
  if (!where.empty()) {
    return fmt::format("The port differs from the reference: {}.", fmt::join(where, ", "));
  }
  if (!port.is_comparison()) {
    return fmt::format(
        "Too few flights to compare the port with the reference: no test can find a difference in "
        "a metric with fewer than {} pairs of flights.",
        port.pairs_needed);
  }
  return "No test shows a difference between the port and the reference.";
}

std::string sim_command_for(const FlightSampler& sampler, std::uint64_t sample,
                            const std::string& port, const std::filesystem::path& kept) {
  const Case& the_case = sampler.nominal().the_case;
  const PlantConfiguration& plant = sampler.nominal().plant_configuration;
  return fmt::format(
      "attest --suite {} sim {}/{}/{} --rate {} --vehicle {} --plant {}{} --html sample_{}.html",
      shell_word(kept.string()), the_case.profile, the_case.group, kept_name(the_case.name, sample),
      sampler.sweep().rate.to_string(), kept_name(plant.vehicle, sample), name_of(plant.plant),
      port.empty() ? "" : " --port " + shell_word(port), sample);
}

std::string render_sweep(const FlightSampler& sampler, const SampleColumns& columns,
                         const SweepSummary& summary, const std::string& port,
                         const std::filesystem::path& kept) {
  std::string out = fmt::format("{}; {}: {}\n", heading_of(sampler, summary),
                                port.empty() ? "reference" : one_line(port), outcomes_of(summary));
  if (const std::string ending = ending_of(sampler.sweep(), summary); !ending.empty()) {
    out += ending + "\n";
  }
  out += requirements_of(sampler.sweep(), summary);
  out += metrics_of(summary);
  out += sensitivity_of(columns, summary);
  out += indices_of(sampler.sweep(), summary);
  if (summary.port) out += difference_of(sampler.sweep(), *summary.port);
  if (!kept.empty()) out += worst_of(sampler, summary, port, kept);
  return out;
}

}  // namespace attest
