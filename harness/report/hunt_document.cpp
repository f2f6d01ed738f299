#include "harness/report/hunt_document.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/json_text.hpp"
#include "harness/report/conclusion.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/finding_values.hpp"
#include "harness/report/text.hpp"
#include "harness/verify/verdict_json.hpp"

namespace attest {
namespace {

using nlohmann::ordered_json;

std::string title_of(const HuntReport& report) {
  return fmt::format("hunt of {} (seed {}, {})", report.run.port, report.seed,
                     name_of(report.run.level));
}

std::string sentence_of(const HuntReport& report) {
  const HuntProgress& progress = report.found.progress;
  return fmt::format("{} in {} and {}", counted(report.found.findings.size(), "finding"),
                     counted(progress.trials, "trial"), counted(progress.steps, "step"));
}

// "fits `a`, `b`", or with many faults their number.
std::string fits(const Suspect& suspect) {
  if (suspect.others > suspect.ambiguity_group.size()) {
    return fmt::format("fits {} mistakes of the catalogue", 1 + suspect.others);
  }
  std::string out = fmt::format("fits {}", suspect.fault->id);
  for (const faults::Fault* other : suspect.ambiguity_group) out += fmt::format(", {}", other->id);
  return out;
}

std::string resemblance(const HuntFinding& finding) {
  if (const faults::Fault* fault = fault_of(finding)) {
    return fmt::format("{}: {}", fault->id, fault->what);
  }
  if (!finding.failure.first) return "";
  const std::string stages = stages_text(stages_of(*finding.failure.first));
  if (finding.suspect) return stages + "; " + fits(*finding.suspect);
  return finding.pattern.empty() ? stages : fmt::format("{}: values {}", stages, finding.pattern);
}

std::vector<Cell> row_of(const HuntFinding& finding) {
  const VectorResult& failure = finding.failure;
  return {Cell(finding.name, failure.verdict),
          failure.profile,
          failure.name,
          failure.rate.to_string(),
          std::to_string(finding.trace.samples.size()),
          std::to_string(finding.trials),
          resemblance(finding)};
}

void add_lines(const HuntFinding& finding, const HuntReport::Written& written, HuntCases cases,
               std::vector<Cell>& lines) {
  lines.emplace_back(fmt::format("{}: {}", finding.name, failure_headline(finding.failure)));
  if (finding.needs_others) {
    lines.emplace_back(
        "  fails only after other trials in the same process of the port: an "
        "earlier instance has left state behind");
    return;
  }
  if (!written.case_file.empty()) lines.emplace_back("  case: " + written.case_file);
  if (!written.command.empty()) lines.emplace_back("  reproduce: " + written.command);
  if (cases == HuntCases::left_out) return;
  constexpr std::size_t most_lines = 40;
  const auto text = lines_of(finding.toml);
  for (std::size_t i = 0; i < std::min(text.size(), most_lines); ++i) {
    lines.emplace_back("    " + text[i]);
  }
  if (text.size() > most_lines) {
    lines.emplace_back(
        fmt::format("    and {} more lines; --out DIR writes it", text.size() - most_lines));
  }
}

// Of each finding its values, with a link to them, and its plots.
void add_values(const std::vector<HuntFinding>& findings, Document& document) {
  for (std::size_t i = 0; i < findings.size(); ++i) {
    DocumentTable values = values_of(findings[i]);
    if (values.rows.empty()) continue;
    document.tables.front().rows[i].front().link = values.id;
    document.tables.push_back(std::move(values));
    PlotGroup plots = plots_of(findings[i]);
    if (!plots.plots.empty()) document.groups.push_back(std::move(plots));
  }
}

}  // namespace

Document hunt_document(const HuntReport& report, HuntCases cases) {
  const auto& findings = report.found.findings;
  Document document;
  document.head = {findings.empty() ? Conclusion::pass : Conclusion::fail, title_of(report),
                   sentence_of(report)};
  document.facts = {{"attest", report.run.attest_version}, {"port", report.run.port}};
  const std::string& ended_early = report.found.ended_early;
  if (!ended_early.empty()) document.notes.push_back({"ended early: " + ended_early, false});
  for (const std::string& note : report.notes) document.notes.push_back({note, false});
  if (findings.empty()) return document;
  DocumentTable table{"Findings",
                      {"case", "profile", "module", "rate [Hz]", "ticks", "trials", "resembles"}};
  for (std::size_t i = 0; i < findings.size(); ++i) {
    table.rows.push_back(row_of(findings[i]));
    add_lines(findings[i], i < report.written.size() ? report.written[i] : HuntReport::Written(),
              cases, table.below);
  }
  const bool has_files = !report.suite.empty();
  if (has_files) {
    const std::string suite = "attest --suite " + shell_word(report.suite);
    table.below.emplace_back(fmt::format("  run all: {} run --group hunt --port {}", suite,
                                         shell_word(report.run.port)));
    table.below.emplace_back(
        fmt::format("  keep: write the `why` of the cases, then {} bless --group hunt --yes "
                    "--reason \"found by "
                    "hunt\"",
                    suite));
  }
  const bool has_cases = !std::ranges::all_of(findings, &HuntFinding::needs_others);
  if (cases == HuntCases::left_out && has_cases && !has_files) {
    table.below.emplace_back(
        "  --out DIR writes each finding as a case, with the command that runs it; --verbose "
        "prints "
        "the cases");
  }
  document.tables.push_back(std::move(table));
  add_values(findings, document);
  return document;
}

RunResult run_of(const HuntReport& report) {
  RunResult run = report.run;
  for (const HuntFinding& finding : report.found.findings) {
    run.results.push_back(finding.failure);
    run.results.back().name = finding.name;
    if (finding.failure.reason.empty()) {
      run.results.back().reason = resemblance(finding);
    }
  }
  return run;
}

std::string hunt_json(const HuntReport& report) {
  ordered_json findings = ordered_json::array();
  for (std::size_t i = 0; i < report.found.findings.size(); ++i) {
    const HuntFinding& finding = report.found.findings[i];
    const auto written = i < report.written.size() ? report.written[i] : HuntReport::Written();
    const faults::Fault* const fault = fault_of(finding);
    VectorResult result = finding.failure;
    result.name = finding.name;
    result.elapsed_s = 0;
    findings.push_back({{"name", finding.name},
                        {"fault", fault != nullptr ? ordered_json(fault->id) : ordered_json()},
                        {"fits", fitting_faults(finding)},
                        {"trials", finding.trials},
                        {"result", to_json(result)},
                        {"case", finding.toml},
                        {"case_file", written.case_file},
                        {"trace_file", written.trace_file},
                        {"command", written.command}});
  }
  const HuntProgress& progress = report.found.progress;
  return document_of({{"schema", "attest-hunt-1"},
                      {"attest_version", report.run.attest_version},
                      {"port", report.run.port},
                      {"level", name_of(report.run.level)},
                      {"seed", report.seed},
                      {"trials", progress.trials},
                      {"steps", progress.steps},
                      {"ended_early", report.found.ended_early},
                      {"notes", report.notes},
                      {"findings", findings}});
}

}  // namespace attest
