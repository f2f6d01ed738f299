#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/file.hpp"
#include "harness/core/json_text.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/report.hpp"
#include "harness/report/statement.hpp"
#include "harness/report/text.hpp"
#include "harness/verify/expected_failures.hpp"

namespace attest {
namespace {

const char* severity_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::crash:
    case Verdict::timeout:
    case Verdict::protocol:
      return "critical";
    case Verdict::xpass:
      return "minor";
    default:
      return "major";
  }
}

}  // namespace

std::string code_quality_report(const RunResult& run, const std::optional<Diagnosis>& diagnosis) {
  nlohmann::ordered_json entries = nlohmann::ordered_json::array();
  std::set<std::string> known;
  for (const VectorResult& result : run.results) {
    const std::string key = fmt::format("{} {}", result.case_id(), name_of(result.verdict));
    if (!fails_a_run(result.verdict) || !known.insert(key).second) continue;
    std::string what = fmt::format("{}: {}: {}", one_line(result.id()), name_of(result.verdict),
                                   failure_headline(result));
    if (diagnosis && !diagnosis->suspects.empty()) {
      what += fmt::format("; it looks like `{}`", diagnosis->suspects.front().fault->id);
    }
    entries.push_back(
        {{"description", what},
         {"check_name", fmt::format("attest {}", name_of(result.verdict))},
         {"fingerprint", sha256(key)},
         {"severity", severity_of(result.verdict)},
         {"location", {{"path", run.case_files.at(result.case_id())}, {"lines", {{"begin", 1}}}}}});
  }
  return document_of(entries);
}

std::span<const ReportFormat> report_formats() {
  static const ReportFormat formats[] = {
      {"--html", "Write an HTML page of the results; that of `run` has plots of failing vectors",
       html_report, true},
      {"--junit", "Write a JUnit XML report",
       [](const Report& of) { return junit_report(of.run, of.diagnosis); }},
      {"--json", "Write a JSON report",
       [](const Report& of) { return json_report(of.run, of.diagnosis); }},
      {"--code-quality", "Write a code quality report for GitLab (JSON)",
       [](const Report& of) { return code_quality_report(of.run, of.diagnosis); }},
      {"--badge",
       "Write an SVG badge: green if the port conforms, amber if the result is "
       "partial or of the level events, red if a vector failed or none passed",
       [](const Report& of) { return badge(of.run); }},
      {"--write-expected",
       "Write the failures as a file for --expected-failures, in which you fill in "
       "the reasons",
       [](const Report& of) { return expected_failures_of(of.run); }},
  };
  return formats;
}

}  // namespace attest
