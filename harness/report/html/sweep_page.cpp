#include "harness/report/html/sweep_page.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "harness/report/html/plot_page.hpp"
#include "harness/report/html/sweep_plots.hpp"
#include "harness/report/sweep_summary_text.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

// More columns would make the table of the worst flights hard to read.
constexpr std::size_t most_shown_dispersions = 12;

std::string figure(double value) { return fmt::format("{:.4g}", value); }
std::string figure(const std::optional<double>& value) { return value ? figure(*value) : "-"; }

Verdict verdict_on(RequirementDecision decision) {
  return decision == RequirementDecision::met ? Verdict::pass : Verdict::fail;
}

PageTable requirements_table(const SweepRun& run) {
  const SweepFile& sweep = run.sampler.sweep();
  PageTable table{"Requirements",
                  {"requirement", "metric", "bounds", "held", probability_heading(sweep), "needed",
                   "decision"}};
  for (const RequirementResult& one : run.summary.requirements) {
    table.rows.push_back({one.requirement.name,
                          one.requirement.metric,
                          bounds_of(one.requirement),
                          fmt::format("{} of {}", one.held, one.count),
                          probability_of(sweep, one),
                          fmt::format("{:g}", one.requirement.probability),
                          {std::string(name_of(one.decision)), verdict_on(one.decision)}});
  }
  return table;
}

PageTable metrics_table(const SweepSummary& summary) {
  PageTable table{"Metrics of the flights that were done",
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

PageCell difference_cell(double p_value, bool differs) {
  if (differs) return {fmt::format("{:.2g}, differs", p_value), Verdict::fail};
  return fmt::format("{:.2g}", p_value);
}

PageTable difference_table(const SweepFile& sweep, const PortDifference& port) {
  PageTable table{
      fmt::format("Port minus reference on the same samples; above, below: flights that differ by "
                  "more than {:g} of the reference's value",
                  sweep.tie),
      {"metric", "flights", "above", "below", "median", "p1", "p99", "p of the sign test"}};
  for (const MetricDifference& one : port.metrics) {
    table.rows.push_back({one.name, fmt::to_string(one.count), fmt::to_string(one.above),
                          fmt::to_string(one.below), figure(one.median), figure(one.p1),
                          figure(one.p99), difference_cell(one.p_value, one.differs)});
  }
  table.rows.push_back({"lost flights", "", fmt::to_string(port.lost_by_port),
                        fmt::to_string(port.lost_by_reference), "", "", "",
                        difference_cell(port.p_value, port.losses_differ)});
  return table;
}

PageTable correlation_table(const SweepRun& run) {
  PageTable table{"Rank correlation (Spearman) of dispersions and metrics", {"dispersion"}};
  table.header.insert(table.header.end(), run.columns.metrics.begin(), run.columns.metrics.end());
  for (std::size_t d = 0; d < run.columns.dispersions.size(); ++d) {
    std::vector<PageCell> row = {run.columns.dispersions[d]};
    for (const MetricSummary& one : run.summary.metrics) {
      const double correlation = one.correlation[d];
      row.emplace_back(std::isnan(correlation) ? "-" : fmt::format("{:+.2f}", correlation));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

PageTable indices_table(const SweepRun& run, const MetricSummary& metric) {
  PageTable table{indices_heading(run.sampler.sweep(), metric),
                  {"dispersion", "first order", "total"}};
  for (std::size_t i = 0; i < metric.sobol->dimensions.size(); ++i) {
    const SobolIndex& one = metric.sobol->dimensions[i];
    table.rows.push_back({run.summary.dimensions[i], index_text(one.first, one.first_interval),
                          index_text(one.total, one.total_interval)});
  }
  return table;
}

PageTable worst_table(const SweepRun& run, const RequirementResult& result) {
  const std::size_t shown = std::min(most_shown_dispersions, run.columns.dispersions.size());
  PageTable table{fmt::format("Worst flights for {}", result.requirement.name), {"sample"}};
  table.header.push_back("outcome");
  for (const std::string& name : run.columns.metrics) table.header.push_back(name);
  for (std::size_t d = 0; d < shown; ++d) table.header.push_back(run.columns.dispersions[d]);
  table.header.push_back("fly it again");
  const PilotData& judged = run.data.pilots.back();
  for (const std::uint64_t sample : result.worst) {
    std::vector<PageCell> row = {fmt::to_string(sample), judged.outcomes[sample]};
    for (const std::vector<double>& values : judged.metrics) {
      row.emplace_back(std::isnan(values[sample]) ? "-" : figure(values[sample]));
    }
    for (std::size_t d = 0; d < shown; ++d) row.emplace_back(figure(run.data.drawn[d][sample]));
    row.emplace_back(sim_command_for(run.sampler, sample, run.identity.port, run.kept));
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::vector<PageTable> tables_of(const SweepRun& run) {
  std::vector<PageTable> tables;
  if (!run.summary.requirements.empty()) tables.push_back(requirements_table(run));
  if (run.summary.port) tables.push_back(difference_table(run.sampler.sweep(), *run.summary.port));
  tables.push_back(metrics_table(run.summary));
  tables.push_back(correlation_table(run));
  for (const MetricSummary& one : run.summary.metrics) {
    if (one.sobol) tables.push_back(indices_table(run, one));
  }
  for (const RequirementResult& one : run.summary.requirements) {
    if (!one.worst.empty()) tables.push_back(worst_table(run, one));
  }
  return tables;
}

std::string sentence_of(const SweepRun& run) {
  const auto decided = [&](RequirementDecision decision) {
    const auto& all = run.summary.requirements;
    return std::count_if(all.begin(), all.end(),
                         [&](const RequirementResult& one) { return one.decision == decision; });
  };
  std::string sentence;
  if (!run.summary.requirements.empty()) {
    sentence = fmt::format("Requirements: {} met, {} not met, {} undecided. ",
                           decided(RequirementDecision::met), decided(RequirementDecision::not_met),
                           decided(RequirementDecision::undecided));
  }
  if (run.summary.port) sentence += difference_text(*run.summary.port) + " ";
  return sentence + fmt::format("Flights: {}.", outcomes_of(run.summary));
}

PageConclusion page_conclusion(const SweepRun& run) {
  const bool passes = run.summary.passes();
  return {passes ? Verdict::pass : Verdict::fail, passes ? "pass" : "fail",
          heading_of(run.sampler, run.summary), sentence_of(run)};
}

std::vector<PageNote> notes_of(const SweepRun& run, const SweepPlots& plots) {
  std::vector<PageNote> notes;
  if (const std::string ending = ending_of(run.sampler.sweep(), run.summary); !ending.empty()) {
    notes.push_back({ending + "."});
  }
  if (run.data.samples() > most_drawn_samples) {
    notes.push_back({fmt::format(
        "The plots are thinned: a distribution has {} quantiles and the outermost {} values at "
        "each end; a metric over a dispersion has {} of {} samples, chosen at random, and the "
        "worst ones. The tables are of all samples.",
        most_drawn_quantiles, drawn_tail, most_drawn_samples, run.data.samples())});
  }
  if (plots.scatter_plots > most_scatter_plots) {
    notes.push_back(
        {fmt::format("Of {} plots of a metric over a dispersion, the {} with the "
                     "strongest rank correlation are drawn.",
                     plots.scatter_plots, most_scatter_plots)});
  }
  if (run.columns.dispersions.size() > most_shown_dispersions && !run.kept.empty()) {
    notes.push_back(
        {fmt::format("The tables of the worst flights have the first {} of {} "
                     "dispersions; samples.csv has all.",
                     most_shown_dispersions, run.columns.dispersions.size())});
  }
  if (run.kept.empty() && !run.summary.requirements.empty()) {
    notes.push_back(
        {"No worst flight was kept. `--keep-worst K` keeps and marks the worst flights "
         "of each requirement."});
  }
  return notes;
}

std::vector<PageFact> facts_of(const SweepRun& run) {
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

std::string sweep_page(const SweepRun& run) {
  SweepPlots plots = sweep_plots(run.sampler.sweep(), run.columns, run.data, run.summary);
  PlotPage page;
  page.conclusion = page_conclusion(run);
  page.notes = notes_of(run, plots);
  page.facts = facts_of(run);
  page.tables = tables_of(run);
  page.groups = std::move(plots.groups);
  return plot_page(page);
}

}  // namespace attest
