// The reports that `run` and `merge` write to files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "harness/diagnosis/diagnose.hpp"
#include "harness/verify/run_result.hpp"

namespace attest {

// The input of every report of a run.
struct Report {
  const RunResult& run;
  std::optional<Diagnosis> diagnosis;
  // The folder of save_traces(), with the traces of some failing vectors; empty: no traces.
  std::filesystem::path traces;
};

// The options of `run` and `merge` are made from the list of formats.
struct ReportFormat {
  std::string option;  // of `attest run`: "--junit"
  std::string help;
  std::function<std::string(const Report&)> render;
  bool plots_traces = false;  // the report reads Report::traces
};
std::span<const ReportFormat> report_formats();

// The report as one HTML page. The page needs no other file and no network, and its tables can be
// read without scripts. The plots get the bytes that the rest of the page leaves free. Text of the
// port (name, reasons) is escaped. A content security policy admits only the scripts of the page.
// Deterministic, as the JSON report.
inline constexpr std::size_t most_page_bytes = 4'900'000;
std::string html_report(const Report& report);

// The machine-readable report. Its format is report.schema.json, next to this file; a change that
// readers can notice changes `schema`. Deterministic: the same run on the same day gives the same
// bytes. So it has a date, but no times.
std::string json_report(const RunResult& run, const std::optional<Diagnosis>& diagnosis = {});

// The report for CI servers, in the JUnit dialect that Jenkins, GitLab and GitHub's reporters have
// in common (tests/harness/report/junit.xsd).
//
// A group is a testsuite, a vector is a testcase, and the failure text is the content of <failure>
// (fail, non-finite, xpass) or <error> (crash, timeout, protocol): GitLab shows content, not
// `message`. For a vector with a first deviation, the content includes the run's diagnosis.
// unsupported, skip and xfail are <skipped>. Of testcases with equal classname and name, GitLab
// shows only the first one, so the name has the rate. Errors of the environment are a testsuite of
// their own, "attest.environment". The time of a testcase is that of its vector; other times are
// sums.
std::string junit_report(const RunResult& run, const std::optional<Diagnosis>& diagnosis = {});

// The failures of a run as a code quality report of GitLab (the format of Code Climate): a JSON
// array with an entry for each failing case and verdict, at its first failing vector. The
// fingerprint is the hash of case and verdict, so that GitLab recognises a known failure.
std::string code_quality_report(const RunResult& run, const std::optional<Diagnosis>& diagnosis);

}  // namespace attest
