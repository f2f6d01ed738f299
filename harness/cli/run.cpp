#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "harness/cli/command.hpp"
#include "harness/cli/conclude.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/plotted_traces.hpp"
#include "harness/cli/run_plan.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/core/interrupt.hpp"
#include "harness/report/progress.hpp"

namespace attest::cli {
namespace {

Result<void> check_paths(const RunOptions& options, const std::string& suite) {
  std::vector<std::string> outputs;
  for (const auto& [option, path] : options.report.files) outputs.push_back(path);
  auto checked = check_outputs(
      outputs,
      {options.host.port, {options.expected_failures, options.timing, options.select.rerun_failed}},
      suite);
  if (!checked) return checked;
  return prepare_trace_folder(options.save_traces, suite);
}

// Runs all vectors. False: interrupted, and the results are not complete.
bool run_all(const RunOptions& options, const Globals& globals, RunPlan& plan) {
  Progress progress(plan.run.selected, Progress::on_stderr(globals.quiet));
  JobOptions<VectorResult> jobs;
  jobs.processes = options.jobs;
  jobs.in_process = options.host.in_process;
  jobs.fail_fast = options.fail_fast;
  jobs.on_result = [&](const VectorResult& result) { progress.add(result); };
  jobs.fails = [&](const VectorResult& result) {
    return fails_a_run(result.verdict) && !(plan.expected && plan.expected->expects(result));
  };
  jobs.stop = interrupted;
  JobResults<VectorResult> outcome = run_jobs(plan.jobs, jobs);
  progress.finish();
  RunResult& run = plan.run;
  run.results = std::move(outcome.results);
  run.errors = std::move(outcome.errors);
  run.stopped_early = outcome.stopped_early;
  if (auto same = check_port(plan.host); !same) run.errors.push_back(same.error());
  return !interrupted();
}

}  // namespace

int run_command(const RunOptions& options, const Globals& globals) {
  const auto begin = std::chrono::steady_clock::now();
  note_interrupts();  // before the first request to the port, which may hang
  const auto suite = find_suite(globals.suite);
  if (!suite) return report_error(suite.error());
  if (const auto checked = check_paths(options, globals.suite); !checked) {
    return report_error(checked.error());
  }
  const auto traces = PlottedTraces::prepare(options);
  if (!traces) return report_error(traces.error());
  auto reports = open_reports(options.report);
  if (!reports) return report_error(reports.error());
  auto plan = make_plan(traces->planned(options), *suite);
  if (!plan) return report_error(plan.error());
  plan->run.suite_folder = globals.suite;
  if (!run_all(options, globals, *plan)) {
    fmt::print(stderr, "attest: interrupted; no report was written\n");
    return exit_interrupted;
  }

  RunResult& run = plan->run;
  const bool is_complete = options.timing.empty() && options.select.selects_all() &&
                           !run.stopped_early && run.errors.empty();
  if (plan->expected) plan->expected->apply(is_complete, run);
  traces->save(*plan, *suite, options);
  if (!options.save_traces.empty() && run.failed()) {
    fmt::print(stderr, "attest: note: the traces of the failing vectors are in {}\n",
               options.save_traces);
  }
  return conclude(run, {plan->cases, plan->host, options.jobs, traces->folder()}, options.report,
                  *std::move(reports), begin, globals);
}

}  // namespace attest::cli
