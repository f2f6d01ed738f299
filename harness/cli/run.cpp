#include <algorithm>
#include <chrono>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/cli/conclude.hpp"
#include "harness/cli/last_run.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/plotted_traces.hpp"
#include "harness/cli/run_plan.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/stdout_diversion.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/core/interrupt.hpp"
#include "harness/report/progress.hpp"
#include "harness/verify/silent_topics.hpp"

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

// Tells from the results, in the order in which they come, whether the port hangs. Without this, it
// costs the time limit for each of thousands of vectors.
class HangWatch {
 public:
  static constexpr int most_cases = 5;

  void add(const VectorResult& result) {
    if (hangs()) return;
    if (result.verdict != Verdict::timeout) {
      cases_ = 0;
      return;
    }
    // After a timeout, the other vectors of the process get this verdict without a run. They are
    // of the same case.
    const std::string name = result.profile + "/" + result.group + "/" + result.name;
    if (cases_ == 0 || name != last_) ++cases_;
    last_ = name;
  }

  bool hangs() const { return cases_ == most_cases; }

 private:
  int cases_ = 0;  // in a row that ended by a timeout
  std::string last_;
};

std::vector<NotRun> not_run(const RunPlan& plan) {
  std::set<std::string> done;
  for (const VectorResult& result : plan.run.results) done.insert(result.id());
  std::vector<NotRun> left;
  for (const SelectedCase& selected : plan.cases) {
    const Case& the_case = selected.the_case;
    for (const RunConfiguration& one : selected.configurations) {
      if (done.contains(the_case.id_at(one))) continue;
      const auto known = std::ranges::find_if(left, [&](const NotRun& other) {
        return other.profile == the_case.profile && other.group == the_case.group &&
               other.rate == one.rate;
      });
      if (known == left.end())
        left.push_back({the_case.profile, the_case.group, one.rate, 1});
      else
        ++known->vectors;
    }
  }
  return left;
}

std::size_t flights_of(const RunPlan& plan) {
  std::size_t flights = 0;
  for (const SelectedCase& selected : plan.cases) {
    flights += static_cast<std::size_t>(std::ranges::count_if(
        selected.configurations,
        [](const RunConfiguration& one) { return one.plant_configuration.has_value(); }));
  }
  return flights;
}

// Runs the vectors, until an interrupt or until the port seems to hang.
void run_all(const RunOptions& options, const Globals& globals, RunPlan& plan) {
  if (kind_of(plan.host.port).is_program && options.select.selects_all() && !globals.quiet) {
    fmt::print(stderr,
               "attest: note: {} are selected; for a slow port, --core selects few that catch the "
               "same mistakes\n",
               counted(plan.run.selected, "vector"));
  }
  Progress progress(plan.run.selected, Progress::on_stderr(globals.quiet), 0, flights_of(plan));
  JobOptions<VectorResult> jobs;
  jobs.processes = options.jobs;
  jobs.in_process = options.host.in_process;
  jobs.fail_fast = options.fail_fast;
  HangWatch watch;
  jobs.on_result = [&](const VectorResult& result) {
    progress.add(result);
    watch.add(result);
  };
  jobs.fails = [&](const VectorResult& result) {
    return fails_a_run(result.verdict) && !(plan.expected && plan.expected->expects(result));
  };
  jobs.stop = [&] { return interrupted() || watch.hangs(); };
  JobResults<VectorResult> outcome = run_jobs(plan.jobs, jobs);
  progress.finish();
  if (watch.hangs()) {
    fmt::print(stderr, "attest: note: stopped, because {} cases in a row ended by a timeout\n",
               HangWatch::most_cases);
  }
  RunResult& run = plan.run;
  run.results = std::move(outcome.results);
  settle_silent_topics(run.results, [&](const VectorResult& result) {
    return plan.expected && plan.expected->expects(result);
  });
  run.errors = std::move(outcome.errors);
  run.stopped_early = outcome.stopped_early || watch.hangs() || interrupted();
  if (run.stopped_early) run.not_run = not_run(plan);
  if (run.not_run.empty()) run.stopped_early = false;  // Ctrl-C after the last vector
  if (auto same = check_port(plan.host); !same) run.errors.push_back(same.error());
}

// A filter selects the cases of its name, such as rate_law/landed, also if a group has this name.
std::string group_meant(const std::vector<std::string>& filters, const SuiteFolder& suite) {
  for (const std::string& group : suite.groups()) {
    const std::string name = group.substr(group.find('/') + 1);
    if (std::ranges::find(filters, name) == filters.end()) continue;
    return fmt::format("; `{0}` is also a group: write `--group {0}`", name);
  }
  return "";
}

int run_command(const RunOptions& given, const Globals& globals) {
  RunOptions options = given;
  if (options.select.last_failed) {
    auto report = last_failed_run();
    if (!report) return report_error(report.error());
    options.select.rerun_failed = *std::move(report);
  }
  // Goldens of earlier runs may be there.
  if (!options.save_traces.empty()) globals.barrier->hidden.push_back(options.save_traces);
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
  StdoutDiversion diversion(options.host.in_process);
  auto plan = make_plan(traces->planned(options), *suite);
  if (!plan) return report_error(plan.error());
  plan->run.suite_folder = globals.suite;
  run_all(options, globals, *plan);
  RunResult& run = plan->run;
  if (interrupted()) {
    if (run.results.empty()) return report_error({"interrupted; no vector was run"});
    fmt::print(stderr, "attest: interrupted; the reports have the vectors that were run\n");
    forget_interrupt();
    if (plan->expected) plan->expected->apply(false, run);
    remember_last_run(run);
    ReportOptions without_diagnosis = options.report;
    without_diagnosis.diagnose = false;
    diversion.end();
    conclude(run, {plan->cases, plan->host, options.jobs, {}}, without_diagnosis,
             *std::move(reports), begin, globals);
    return exit_interrupted;
  }
  const bool is_complete = options.timing.empty() && options.select.selects_all() &&
                           !run.stopped_early && run.errors.empty();
  if (plan->expected) plan->expected->apply(is_complete, run);
  remember_last_run(run);
  if (!options.save_traces.empty() && run.failed()) {
    fmt::print(stderr, "attest: note: the traces of the failing vectors are in {}\n",
               options.save_traces);
  }
  const auto save_traces = [&](const std::string& named) {
    traces->save(*plan, *suite, options, named);
    diversion.end();  // from here on, the port does not run
  };
  const auto suggestion = [&] { return group_meant(options.select.filters, *suite); };
  return conclude(
      run, {plan->cases, plan->host, options.jobs, traces->folder(), save_traces, suggestion},
      options.report, *std::move(reports), begin, globals);
}

void add_strictness(Command command, RunOptions& options) {
  command
      .option("--level", options.level,
              "How outputs are compared: `exact` (float32 bits), `numeric` (a tolerance for "
              "each signal) or `events` (events at most one tick apart, values within wide "
              "bounds; flights as at `numeric`)")
      .type("LEVEL")
      .shows_default()
      .group(option_group::strictness);
  add_parameters(
      command, options.parameters,
      "Set a parameter of port and reference in each open-loop case; flights are not run")
      .group(option_group::strictness);
  command
      .option("--expected-failures", options.expected_failures,
              "Accept the failures that this TOML file lists; the run fails if a listed case "
              "passes")
      .type("F")
      .group(option_group::strictness);
}

void add_execution(Command command, RunOptions& options) {
  add_jobs(command, options.jobs, "Number of worker processes");
  command.flag("--fail-fast", options.fail_fast, "Stop after the first failure")
      .group(option_group::execution);
  add_timeout(command, options.host.timeout_s);
  command
      .flag("--in-process", options.host.in_process,
            "Run the port in attest's own process, for a debugger or a sanitizer; what it prints "
            "is shown on stderr, and the result is partial")
      .group(option_group::execution);
}

void add_traces(Command command, RunOptions& options) {
  command
      .option("--save-traces", options.save_traces,
              "Write the outputs of each failing vector (.got.csv), the expected outputs "
              "(.want.csv) and, except at the level events, the tolerances (.tolerance.csv) "
              "to this new folder")
      .type("DIR")
      .group(option_group::reports);
  command.find("--write-expected").excludes(command.find("--expected-failures"));
}

}  // namespace

void add_run(const CommandLine& line) {
  auto options = std::make_shared<RunOptions>();
  const Command command =
      line.add("run", "Run the cases on a port, and compare its outputs with the expected ones");
  add_port(command, options->host, Ports::any);
  add_port_argument(command, options->host);
  add_selection(command, options->select);
  command.option("--shard", options->select.shard, "Run only part I of N of the cases")
      .type("I/N")
      .shows_default()
      .group(option_group::selection);
  command
      .option("--rerun-failed", options->select.rerun_failed,
              "Run only the vectors that failed in this JSON report; give the same --level "
              "and --param as in that run")
      .type("REPORT")
      .group(option_group::selection);
  command
      .flag(
          "--last-failed", options->select.last_failed,
          "Run only the vectors that failed in the last run in this folder; give the same --port, "
          "--level and --param as in that run")
      .group(option_group::selection)
      .excludes(command.find("--rerun-failed"));
  command
      .option("--timing", options->timing,
              "Run only the flight of this file from --record-timing, at the recorded times")
      .type("F")
      .group(option_group::selection);
  add_strictness(command, *options);
  add_execution(command, *options);
  add_reports(command, options->report);
  add_traces(command, *options);
  command.examples(
      {{"attest run", "the built-in reference, all vectors"},
       {"attest run --port lib:./libmine.so", "your port"},
       {"attest run --port recorded:DIR",
        "judge the files in DIR, whose inputs `attest vectors DIR` wrote"},
       {"attest run --port lib:./libmine.so --level exact --filter 'attitude/*@250hz'",
        "compare some vectors to the bit"},
       {"attest run --port lib:./libmine.so --exclude 'flight*/*' --junit attest.junit.xml",
        "leave out the flights, and write a report for CI"},
       {"attest run --port lib:./libmine.so --html attest.html",
        "write a page with plots of the failing vectors"},
       {"attest run --port lib:./libmine.so --rerun-failed attest.json",
        "run again what failed in a run with --json attest.json"}});
  command.runs(options, run_command);
}

}  // namespace attest::cli
