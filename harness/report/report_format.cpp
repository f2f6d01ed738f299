#include "harness/report/report_format.hpp"

#include "harness/report/code_quality.hpp"
#include "harness/report/html/html_report.hpp"
#include "harness/report/json.hpp"
#include "harness/report/junit.hpp"
#include "harness/report/statement.hpp"
#include "harness/verify/expected_failures.hpp"

namespace attest {
namespace {

// For a report that needs only the verdicts.
auto of_verdicts(std::string (*render)(const RunResult&)) {
  return [render](const Report& report) { return render(report.run); };
}

auto with_diagnosis(std::string (*render)(const RunResult&, const std::optional<Diagnosis>&)) {
  return [render](const Report& report) { return render(report.run, report.diagnosis); };
}

}  // namespace

std::span<const ReportFormat> report_formats() {
  static const ReportFormat formats[] = {
      {"--html", "Write an HTML page of the results; that of `run` has plots of failing vectors",
       html_report, true},
      {"--junit", "Write a JUnit XML report", with_diagnosis(junit_report)},
      {"--json", "Write a JSON report", with_diagnosis(json_report)},
      {"--code-quality", "Write a code quality report for GitLab (JSON)",
       with_diagnosis(code_quality_report)},
      {"--badge",
       "Write an SVG badge: green if the port conforms, amber if the result is "
       "partial or of the level events, red if a vector failed or none passed",
       of_verdicts(badge)},
      {"--write-expected",
       "Write the failures as a file for --expected-failures, in which you fill in "
       "the reasons",
       of_verdicts(expected_failures_of)},
  };
  return formats;
}

}  // namespace attest
