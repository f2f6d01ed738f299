#include "harness/report/report.hpp"
#include "harness/report/statement.hpp"
#include "harness/verify/expected_failures.hpp"

namespace attest {

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
