#include "harness/report/sweep_document.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/report/failure_text.hpp"
#include "harness/report/html/sweep_plots.hpp"
#include "harness/report/text.hpp"
#include "harness/sweep/keep_flights.hpp"

namespace attest {
namespace {

// More columns would make the table of the worst flights hard to read.
constexpr std::size_t most_shown_dispersions = 12;

std::string figure(double value) { return fmt::format("{:.4g}", value); }
std::string figure(const std::optional<double>& value) { return value ? figure(*value) : "-"; }

// "at most 1.2".
std::string bounds_of(const Requirement& requirement) {
  MetricResult bounds;
  bounds.min = requirement.min;
  bounds.max = requirement.max;
  return metric_bounds(bounds);
}

DocumentTable requirements_table(const SweepRun& run) {
  const SweepFile& sweep = run.sampler.sweep();
  const bool is_grid = sweep.design.kind == DesignKind::grid;
  DocumentTable table{"Requirements",
                      {"requirement", "metric", "bounds", "held",
                       is_grid ? "share" : fmt::format("probability ({:g})", sweep.confidence),
                       "needed", "decision"}};
  for (const RequirementResult& one : run.summary.requirements) {
    const auto [low, high] = one.probability;
    const bool is_met = one.decision == RequirementDecision::met;
    table.rows.push_back(
        {one.requirement.name,
         one.requirement.metric,
         bounds_of(one.requirement),
         fmt::format("{}/{}", one.held, one.count),
         is_grid ? fmt::format("{:.4f}", low) : fmt::format("{:.4f} to {:.4f}", low, high),
         fmt::format("{:g}", one.requirement.probability),
         {std::string(name_of(one.decision)), is_met ? Verdict::pass : Verdict::fail}});
  }
  return table;
}

DocumentTable metrics_table(const SweepSummary& summary) {
  DocumentTable table{"Metrics of the flights that were done",
                      {"metric", "flights", "min", "median", "p95", "p99", "max"}};
  for (const MetricSummary& one : summary.metrics) {
    if (one.count == 0) {
      table.rows.push_back({one.name, "0", "-", "-", "-", "-", "-"});
      continue;
    }
    table.rows.push_back({one.name, fmt::to_string(one.count), figure(one.min), figure(one.median),
                          figure(one.p95), figure(one.p99), figure(one.max)});
  }
  return table;
}

Cell difference_cell(double p_value, bool differs) {
  if (differs)
    return {fmt::format("{:.2g}, {}", p_value, name_of(RowVerdict::differs)), Verdict::fail};
  return fmt::format("{:.2g}", p_value);
}

DocumentTable difference_table(const SweepFile& sweep, const PortDifference& port) {
  DocumentTable table{
      fmt::format("Port minus reference on the same samples; above, below: flights that "
                  "differ by more than {:g} of the reference's value",
                  sweep.tie),
      {"metric", "flights", "above", "below", "median", "p1", "p99", "sign test p"}};
  for (const MetricDifference& one : port.metrics) {
    table.rows.push_back({one.name, fmt::to_string(one.count), fmt::to_string(one.above),
                          fmt::to_string(one.below), figure(one.median), figure(one.p1),
                          figure(one.p99), difference_cell(one.p_value, one.differs)});
  }
  table.rows.push_back({"lost by one only (port, reference)", "", fmt::to_string(port.lost_by_port),
                        fmt::to_string(port.lost_by_reference), "", "", "",
                        difference_cell(port.p_value, port.losses_differ)});
  return table;
}

DocumentTable correlation_table(const SweepRun& run) {
  DocumentTable table{"Rank correlation (Spearman) of dispersions and metrics",
                      {"rank correlation with"}};
  table.header.insert(table.header.end(), run.columns.metrics.begin(), run.columns.metrics.end());
  for (std::size_t d = 0; d < run.columns.dispersions.size(); ++d) {
    std::vector<Cell> row = {run.columns.dispersions[d]};
    for (const MetricSummary& one : run.summary.metrics) {
      const double correlation = one.correlation[d];
      row.emplace_back(std::isnan(correlation) ? "-" : fmt::format("{:+.2f}", correlation));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

// "0.31 (0.28 to 0.34)".
std::string index_text(double value, const Interval& interval) {
  return fmt::format("{:.2f} ({:.2f} to {:.2f})", value, interval.low, interval.high);
}

DocumentTable indices_table(const SweepRun& run, const MetricSummary& metric) {
  const SobolIndices& sobol = *metric.sobol;
  DocumentTable table{fmt::format("Sobol indices of {}, of {} blocks ({:g})", metric.name,
                                  sobol.blocks, run.sampler.sweep().confidence),
                      {"dispersion", "first order", "total"}};
  if (sobol.left_out > 0) {
    table.caption +=
        fmt::format("; {} blocks left out, because a flight has no finite value", sobol.left_out);
  }
  if (sobol.dimensions.empty()) table.caption += "; too few blocks, or the metric does not vary";
  for (std::size_t i = 0; i < sobol.dimensions.size(); ++i) {
    const SobolIndex& one = sobol.dimensions[i];
    table.rows.push_back({run.summary.dimensions[i], index_text(one.first, one.first_interval),
                          index_text(one.total, one.total_interval)});
  }
  return table;
}

// The command that flies a kept sample again.
std::string command_to_fly(const SweepRun& run, std::uint64_t sample) {
  const Case& the_case = run.sampler.nominal().the_case;
  const PlantConfiguration& plant = run.sampler.nominal().plant_configuration;
  const std::string& port = run.identity.port;
  return fmt::format(
      "attest --suite {} sim {}/{}/{} --rate {} --vehicle {} --plant {}{} --html sample_{}.html",
      shell_word(run.kept.string()), the_case.profile, the_case.group,
      kept_name(the_case.name, sample), run.sampler.sweep().rate.to_string(),
      kept_name(plant.vehicle, sample), name_of(plant.plant),
      port.empty() ? "" : " --port " + shell_word(port), sample);
}

DocumentTable worst_table(const SweepRun& run, const RequirementResult& result) {
  const std::size_t shown = std::min(most_shown_dispersions, run.columns.dispersions.size());
  DocumentTable table{fmt::format("Worst flights for {}", result.requirement.name),
                      {"sample", "outcome"}};
  for (const std::string& name : run.columns.metrics) table.header.push_back(name);
  for (std::size_t d = 0; d < shown; ++d) table.header.push_back(run.columns.dispersions[d]);
  const PilotData& judged = run.data.pilots.back();
  for (const std::uint64_t sample : result.worst) {
    std::vector<Cell> row = {fmt::to_string(sample), judged.outcomes[sample]};
    for (const std::vector<double>& values : judged.metrics) {
      row.emplace_back(std::isnan(values[sample]) ? "-" : figure(values[sample]));
    }
    for (std::size_t d = 0; d < shown; ++d) row.emplace_back(figure(run.data.drawn[d][sample]));
    table.rows.push_back(std::move(row));
    table.below.push_back(command_to_fly(run, sample));
  }
  return table;
}

std::vector<DocumentTable> tables_of(const SweepRun& run) {
  std::vector<DocumentTable> tables;
  if (!run.summary.requirements.empty()) tables.push_back(requirements_table(run));
  if (run.summary.port) tables.push_back(difference_table(run.sampler.sweep(), *run.summary.port));
  tables.push_back(metrics_table(run.summary));
  tables.push_back(correlation_table(run));
  for (const MetricSummary& one : run.summary.metrics) {
    if (one.sobol) tables.push_back(indices_table(run, one));
  }
  for (const RequirementResult& one : run.summary.requirements) {
    if (!one.worst.empty() && !run.kept.empty()) tables.push_back(worst_table(run, one));
  }
  return tables;
}

// "The port differs from the reference: settles."
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

std::size_t decided(const SweepSummary& summary, RequirementDecision decision) {
  const auto& all = summary.requirements;
  return static_cast<std::size_t>(
      std::count_if(all.begin(), all.end(),
                    [&](const RequirementResult& one) { return one.decision == decision; }));
}

// "px4-v1.5.5/flight/tilt_step_30@250hz-iris-mujoco: 1000 samples, design sobol; reference: 998
// done, 2 diverged".
std::string title_of(const SweepRun& run) {
  const SweepFile& sweep = run.sampler.sweep();
  const SweepSummary& summary = run.summary;
  const RunConfiguration configuration{sweep.rate, run.sampler.nominal().plant_configuration};
  const bool ended_early = summary.samples < summary.planned;
  std::vector<std::string> outcomes;
  for (const auto& [outcome, count] : summary.outcomes) {
    outcomes.push_back(fmt::format("{} {}", count, outcome));
  }
  return fmt::format(
      "{}: {}{} samples, design {}; {}: {}", run.sampler.nominal().the_case.id_at(configuration),
      summary.samples, ended_early ? fmt::format(" of {}", summary.planned) : "",
      name_of(sweep.design.kind), run.identity.port.empty() ? "reference" : run.identity.port,
      fmt::join(outcomes, ", "));
}

DocumentHead head_of(const SweepRun& run) {
  const bool passes = run.summary.passes();
  std::string sentence;
  if (!run.summary.requirements.empty()) {
    sentence = fmt::format("Requirements: {} met, {} not met, {} undecided. ",
                           decided(run.summary, RequirementDecision::met),
                           decided(run.summary, RequirementDecision::not_met),
                           decided(run.summary, RequirementDecision::undecided));
  }
  if (run.summary.port) sentence += difference_text(*run.summary.port);
  return {passes ? Conclusion::pass : Conclusion::fail, title_of(run), std::move(sentence)};
}

// Notes on the plots and on what is left out are on the page only.
std::vector<Note> notes_of(const SweepRun& run, const SweepPlots& plots) {
  std::vector<Note> notes;
  const auto add = [&](std::string text) { notes.push_back({std::move(text), false, false}); };
  if (run.sampler.sweep().stop_when_decided) {
    const bool is_decided = decided(run.summary, RequirementDecision::undecided) == 0;
    notes.push_back({fmt::format(
        "{}; intervals and tests are sequential: valid although the sweep may end early.",
        is_decided ? "Ended because every requirement is decided"
                   : "Flew all samples, and not every requirement is decided")});
  }
  if (run.data.samples() > most_drawn_samples) {
    add(fmt::format(
        "The plots are thinned: a distribution has {} quantiles and the outermost {} values at "
        "each end; a metric over a dispersion has {} of {} samples, chosen at random, and the "
        "worst ones. The tables are of all samples.",
        most_drawn_quantiles, drawn_tail, most_drawn_samples, run.data.samples()));
  }
  if (plots.scatter_plots > most_scatter_plots) {
    add(
        fmt::format("Of {} plots of a metric over a dispersion, the {} with the strongest rank "
                    "correlation are drawn.",
                    plots.scatter_plots, most_scatter_plots));
  }
  if (run.columns.dispersions.size() > most_shown_dispersions && !run.kept.empty()) {
    add(
        fmt::format("The tables of the worst flights have the first {} of {} dispersions; "
                    "samples.csv has all.",
                    most_shown_dispersions, run.columns.dispersions.size()));
  }
  if (run.kept.empty() && !run.summary.requirements.empty()) {
    add("No worst flight was kept. `--keep-worst K` keeps and marks the worst flights of each "
        "requirement.");
  }
  return notes;
}

std::vector<Fact> facts_of(const SweepRun& run) {
  const SweepFile& sweep = run.sampler.sweep();
  return {{"attest", run.identity.attest_version},
          {"sweep", sweep.file.filename().string()},
          {"hash of sweep file, case, vehicle and samples", run.identity.sweep_sha256},
          {"port", run.identity.port},
          {"hash of the port", run.identity.port_sha256},
          {"confidence", fmt::format("{:g}", sweep.confidence)},
          {"tie", fmt::format("up to {:g} of the reference's value", sweep.tie)}};
}

}  // namespace

Document sweep_document(const SweepRun& run) {
  UnitsOfMetrics units;
  for (const Metric& metric : run.sampler.nominal().the_case.flight->metrics) {
    units[metric.name] = unit_of(metric.measure);
  }
  SweepPlots plots = sweep_plots(run.sampler.sweep(), run.columns, run.data, run.summary, units);
  Document document{head_of(run), notes_of(run, plots)};
  document.facts = facts_of(run);
  document.tables = tables_of(run);
  document.groups = std::move(plots.groups);
  return document;
}

}  // namespace attest
