#include "harness/report/report_format.hpp"

#include "harness/report/code_quality.hpp"
#include "harness/report/html/html_report.hpp"
#include "harness/report/json.hpp"
#include "harness/report/junit.hpp"
#include "harness/report/statement.hpp"
#include "harness/verify/expected.hpp"

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
      {"--html",
       "Write a report as one HTML page, which needs no network; that of `run` has plots of "
       "failing vectors",
       html_report, true},
      {"--junit", "Write a JUnit XML report", with_diagnosis(junit_report)},
      {"--json", "Write a JSON report", with_diagnosis(json_report)},
      {"--code-quality", "Write a code quality report for GitLab (JSON)",
       with_diagnosis(code_quality_report)},
      {"--badge",
       "Write a badge (SVG): green when the port conforms to a profile, amber when the result is "
       "partial, red when something fails or nothing passes",
       of_verdicts(badge)},
      {"--write-expected",
       "Write the failures as a file for --expected-failures; fill in the reasons",
       of_verdicts(expected_failures_of)},
  };
  return formats;
}

}  // namespace attest
