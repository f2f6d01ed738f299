#include <chrono>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "harness/cli/command.hpp"
#include "harness/cli/interrupt.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/plotted_traces.hpp"
#include "harness/cli/run_plan.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/core/file.hpp"
#include "harness/diagnosis/diagnosis_job.hpp"
#include "harness/report/progress.hpp"
#include "harness/report/report_format.hpp"
#include "harness/report/terminal.hpp"

namespace attest::cli {
namespace {

// A report file, opened before the run so that a path that cannot be written is reported at once.
struct ReportFile {
  AtomicFile file;
  const ReportFormat& format;
};

Result<std::vector<ReportFile>> open_reports(const RunOptions& options) {
  std::vector<ReportFile> reports;
  for (const ReportFormat& format : report_formats()) {
    const std::string& path = options.reports.at(format.option);
    if (path.empty()) continue;
    auto file = AtomicFile::open(path);
    if (!file) return tl::unexpected(file.error());
    reports.push_back({*std::move(file), format});
  }
  return reports;
}

Result<void> write_reports(std::vector<ReportFile>& reports, const Report& report) {
  for (auto& [file, format] : reports) {
    if (auto written = file.write(format.render(report)); !written) return written;
    if (auto committed = file.commit(); !committed) return committed;
  }
  return {};
}

// The diagnosis of the failures. Its errors are printed and do not change verdicts.
std::optional<Diagnosis> diagnosed(const RunPlan& plan, int processes) {
  JobOptions<VectorDiagnosis> options;
  options.processes = processes;
  options.in_process = plan.host.in_process;
  options.stop = interrupted;
  const auto vectors = [&](const faults::Fault* partner) {
    std::vector<VectorSimilarity> similarities;
    const auto jobs = diagnosis_jobs(plan.cases, plan.run.results, plan.host, partner);
    auto outcome = run_jobs(jobs, options);
    if (!outcome.errors.empty() && !interrupted()) {
      fmt::print(stderr, "attest: diagnosis: {}\n", outcome.errors.front().to_string());
    }
    for (VectorDiagnosis& vector : outcome.results) {
      if (vector) similarities.push_back(*std::move(vector));
    }
    return similarities;
  };
  auto diagnosis = diagnose(vectors(nullptr));
  if (diagnosis && wants_partner(*diagnosis)) {
    add_partner(vectors(diagnosis->suspects.front().fault), *diagnosis);
  }
  if (!interrupted()) return diagnosis;
  // It would rest on some of the vectors only. The verdicts are complete.
  fmt::print(stderr, "attest: interrupted; the reports do not have the probable mistake\n");
  return std::nullopt;
}

// 0 requires that at least one vector was compared: a port without support for any does not
// conform.
int exit_code(const RunResult& run) {
  if (!run.errors.empty()) return exit_usage;
  if (run.failed()) return exit_failed;
  const bool compared = run.count(Verdict::pass) + run.count(Verdict::xfail) > 0;
  if (!compared) {
    return report_error(
        {"no vector was compared: every selected vector was skipped or unsupported"});
  }
  return exit_ok;
}

Result<void> check_paths(const RunOptions& options, const SuiteFolder& suite) {
  std::vector<std::string> outputs;
  for (const auto& [option, path] : options.reports) outputs.push_back(path);
  auto checked = check_outputs(
      outputs, {options.host.port, {options.expected_failures, options.timing}}, suite);
  if (!checked) return checked;
  return prepare_trace_folder(options.save_traces, suite);
}

// Runs all vectors. False: interrupted, and the results are not complete.
bool run_all(const RunOptions& options, const Globals& globals, RunPlan& plan) {
  Progress progress(plan.results, Progress::on_stderr(globals.quiet));
  JobOptions<CaseResult> jobs;
  jobs.processes = options.jobs;
  jobs.in_process = options.host.in_process;
  jobs.fail_fast = options.fail_fast;
  jobs.on_result = [&](const CaseResult& result) { progress.add(result); };
  jobs.fails = [&](const CaseResult& result) {
    return fails_a_run(result.verdict) && !(plan.expected && plan.expected->expects(result));
  };
  jobs.stop = interrupted;
  JobResults<CaseResult> outcome = run_jobs(plan.jobs, jobs);
  progress.finish();
  RunResult& run = plan.run;
  run.results = std::move(outcome.results);
  run.errors = std::move(outcome.errors);
  run.stopped_early = outcome.stopped_early;
  return !interrupted();
}

}  // namespace

int run_command(const RunOptions& options, const Globals& globals) {
  const auto begin = std::chrono::steady_clock::now();
  note_interrupts();  // before the first request to the port, which may hang
  const auto suite = find_suite(globals.suite);
  if (!suite) return report_error(suite.error());
  if (const auto checked = check_paths(options, *suite); !checked) {
    return report_error(checked.error());
  }
  const auto traces = PlottedTraces::prepare(options);
  if (!traces) return report_error(traces.error());
  auto plan = make_plan(traces->planned(options), *suite);
  if (!plan) return report_error(plan.error());
  plan->run.suite_folder = globals.suite;
  auto reports = open_reports(options);
  if (!reports) return report_error(reports.error());
  if (!run_all(options, globals, *plan)) {
    fmt::print(stderr, "attest: interrupted; no report was written\n");
    return exit_interrupted;
  }

  RunResult& run = plan->run;
  const bool is_complete = options.timing.empty() && options.select.selects_all() &&
                           !run.stopped_early && run.errors.empty();
  if (plan->expected) plan->expected->apply(is_complete, run);
  std::optional<Diagnosis> diagnosis;
  if (!run.suite_reference.empty()) {
    fmt::print(stderr, "attest: note: {}\n", own_law_only);
  } else if (options.diagnose && run.failed() && run.parameters.empty()) {
    diagnosis = diagnosed(*plan, options.jobs);
  }
  traces->save(*plan, *suite, options);
  // Before the summary: if its reader closes the pipe early, SIGPIPE ends this process.
  const auto written = write_reports(*reports, {run, diagnosis, traces->folder()});
  const int code = exit_code(run);
  if (!options.save_traces.empty() && run.failed()) {
    fmt::print(stderr, "attest: note: the traces of the failing vectors are in {}\n",
               options.save_traces);
  }
  if (!globals.quiet || code != exit_ok) {
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    fmt::print("{}", render_summary(run, wall.count(), terminal_style(stdout), diagnosis));
  }
  if (!written) return report_error(written.error());
  return code;
}

}  // namespace attest::cli
