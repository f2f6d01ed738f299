#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/report/accuracy.hpp"
#include "harness/report/conclusion.hpp"
#include "harness/report/document.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/html/plots.hpp"
#include "harness/report/matrix.hpp"
#include "harness/report/report.hpp"
#include "harness/report/statement.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

// The failures without a deviation (a crash, a metric of a flight), counted by reason. The most
// frequent ones come first.
std::vector<Cell> failures_without_deviation(const RunResult& run) {
  constexpr std::size_t most = 8;
  std::vector<Together> reasons = grouped(
      run, [](const VectorResult& result) { return fails_a_run(result.verdict) && !result.first; },
      [](const VectorResult& a, const VectorResult& b) {
        return a.verdict == b.verdict && a.reason == b.reason;
      });
  std::stable_sort(reasons.begin(), reasons.end(),
                   [](const Together& a, const Together& b) { return a.size() > b.size(); });
  if (reasons.size() > most) reasons.resize(most);
  std::vector<Cell> lines;
  for (const Together& group : reasons) {
    const VectorResult& result = *group.front();
    lines.emplace_back(
        fmt::format("{} {}: {}", group.size(), name_of(result.verdict), reason_text(result)),
        result.verdict);
  }
  return lines;
}

std::vector<Section> sections_of(const Report& report) {
  const RunResult& run = report.run;
  std::vector<Section> sections;
  if (report.diagnosis) {
    auto lines = lines_of(diagnosis_text(*report.diagnosis));
    for (std::string& line : lines) {
      line = one_line(line);
      line.front() = static_cast<char>(std::toupper(line.front()));
    }
    sections.push_back({"Probable mistake", {lines.begin(), lines.end()}, true});
  }
  if (auto lines = failures_without_deviation(run); !lines.empty()) {
    sections.push_back({"Vectors that failed without a deviation", std::move(lines)});
  }
  const Statement statement = statement_of(run);
  sections.push_back({"Conformance", {statement.claims.begin(), statement.claims.end()}});
  for (const std::string& line : {statement.subject, first_stages(run)}) {
    if (!line.empty()) sections.back().lines.emplace_back(line);
  }
  return sections;
}

std::vector<Fact> facts_of(const RunResult& run) {
  std::vector<std::string> rates;
  for (const LoopRate& rate : run.rates) rates.push_back(rate.to_string());
  return {{"attest", run.attest_version},
          {"date (UTC)", run.date},
          {"port", run.port},
          {"port, SHA-256", run.port_sha256},
          {"level", std::string(name_of(run.level))},
          {"rates [Hz]", fmt::format("{}", fmt::join(rates, ", "))},
          {"selection", run.selection_text()},
          {"fixed step [Hz]", run.fixed_step ? run.fixed_step->to_string() : ""},
          {"fraction bits", run.fraction_bits ? fmt::to_string(*run.fraction_bits) : ""},
          {"cases, golden", run.cases_version + ", " + run.golden_version},
          {run.suite_is_released ? "released suite, SHA-256" : "custom suite, SHA-256",
           run.suite_sha256},
          {"suite's reference", run.suite_reference}};
}

// What is wrong, how to run the vector again, and how to fly it.
void add_failure(const VectorResult& result, const RunResult& run, std::vector<Cell>& row) {
  std::vector<std::string> texts(9);
  if (result.first) {
    const Deviation& first = *result.first;
    const Channel& channel = channels()[first.channel];
    texts = {fmt::to_string(result.deviating_ticks),
             fmt::to_string(first.tick),
             fmt::to_string(first.timestamp_us),
             channel_with_unit(channel),
             stages_text(stages_of(first)),
             value_text(channel, first.got),
             value_text(channel, first.want),
             distance_text(first, run.level),
             worst_text(result)};
  }
  texts.push_back(reproduce_command(result, run));
  const bool can_fly = result.plant_configuration && run.timing.empty();
  texts.push_back(can_fly ? sim_command(result, run) : "");
  row.insert(row.end(), texts.begin(), texts.end());
}

std::vector<Cell> row_of(const VectorResult& result, const RunResult& run) {
  // In a vector that fails, the headroom of the other outputs means nothing.
  const bool passed = result.verdict == Verdict::pass || result.verdict == Verdict::xpass;
  const Headroom* tightest = passed && result.tightest ? &*result.tightest : nullptr;
  const bool is_explained = result.verdict == Verdict::pass || result.first;
  std::vector<Cell> row = {{std::string(name_of(result.verdict)), result.verdict},
                           result.profile + "/" + result.group,
                           result.name,
                           result.configuration().label(),
                           fmt::to_string(result.ticks),
                           tightest ? fmt::format("{:.6g}", tightest->ratio) : "",
                           tightest ? std::string(channels()[tightest->channel].name) : "",
                           is_explained && result.reason.empty() ? "" : reason_text(result)};
  if (fails_a_run(result.verdict)) add_failure(result, run, row);
  return row;
}

// The page, with an empty element for the plots.
Document run_document(const Report& report) {
  const RunResult& run = report.run;
  Document document{{conclusion_of(run), fmt::format("{} {}", run.port_name, run.port_version),
                     conclusion_text(run)}};
  if (std::string lacks = needless_lacks_text(run); !lacks.empty()) {
    document.notes.push_back({std::move(lacks), false});
  }
  for (const Error& error : run.errors) {
    document.notes.push_back({"error: " + error.to_string(), true});
  }
  document.sections = sections_of(report);
  document.facts = facts_of(run);
  document.tables = matrices_of(run);
  if (auto accuracy = accuracy_of(run)) document.tables.push_back(*std::move(accuracy));
  document.results.emplace();
  document.whys = run.whys;
  if (report.diagnosis) document.first_case = report.diagnosis->specific_case;
  for (const VectorResult& result : run.results) document.results->push_back(row_of(result, run));
  return document;
}

}  // namespace

std::string html_report(const Report& report) {
  // The last occurrence of these characters is that of the template, because mustache escapes the
  // quotes and `>` in the texts of a port.
  constexpr std::string_view begin_of_plots = R"(id="plots">)";
  std::string page = html_page(run_document(report));
  const std::size_t left = most_page_bytes - std::min(most_page_bytes, page.size());
  page.insert(page.rfind(begin_of_plots) + begin_of_plots.size(),
              plots_json(report.run, report.traces, left,
                         report.diagnosis ? report.diagnosis->specific_case : ""));
  return page;
}

}  // namespace attest
