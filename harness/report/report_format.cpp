#include "harness/report/report_format.hpp"

#include "harness/report/code_quality.hpp"
#include "harness/report/json.hpp"
#include "harness/report/junit.hpp"
#include "harness/report/statement.hpp"
#include "harness/verify/expected.hpp"

namespace attest {
namespace {

// For a report without a diagnosis.
auto without_diagnosis(std::string (*render)(const RunResult&)) {
  return [render](const RunResult& run, const std::optional<Diagnosis>&) { return render(run); };
}

}  // namespace

std::span<const ReportFormat> report_formats() {
  static const ReportFormat formats[] = {
      {"--junit", "Write a JUnit XML report", junit_report},
      {"--json", "Write a JSON report", json_report},
      {"--code-quality", "Write a code quality report for GitLab (JSON)", code_quality_report},
      {"--badge",
       "Write a badge (SVG): green when the port conforms to a profile, amber when the result is "
       "partial, red when something fails",
       without_diagnosis(badge)},
      {"--write-expected",
       "Write the failures as a file for --expected-failures; fill in the reasons",
       without_diagnosis(expected_failures_of)},
  };
  return formats;
}

}  // namespace attest
