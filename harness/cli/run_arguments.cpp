#include "harness/cli/run_arguments.hpp"

#include <memory>

#include <CLI/CLI.hpp>

#include "harness/cli/command.hpp"
#include "harness/report/report_format.hpp"

namespace attest::cli {
namespace {

void add_strictness(CLI::App& command, RunOptions& options) {
  command
      .add_option("--level", options.level,
                  "How outputs are compared: `exact` (float32 bits), `numeric` (a tolerance for "
                  "each signal) or `events` (events at most one tick apart, values within wide "
                  "bounds); flights are always judged at `numeric`")
      ->type_name("LEVEL")
      ->capture_default_str()
      ->group(option_group::strictness);
  command
      .add_option("--param", options.parameters,
                  "Set a parameter of port and reference in each open-loop case; flights are not "
                  "run")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false)
      ->group(option_group::strictness);
  command
      .add_option("--expected-failures", options.expected_failures,
                  "Accept the failures that this TOML file lists; the run fails if a listed case "
                  "passes")
      ->type_name("F")
      ->group(option_group::strictness);
}

void add_execution(CLI::App& command, RunOptions& options) {
  add_jobs(command, options.jobs, "Number of worker processes");
  command.add_flag("--fail-fast", options.fail_fast, "Stop after the first failure")
      ->group(option_group::execution);
  add_timeout(command, options.host.timeout_s);
  command
      .add_flag("--in-process", options.host.in_process,
                "Run the port in attest's own process, for a debugger or a sanitizer; the "
                "result is then partial")
      ->group(option_group::execution);
}

void add_reports(CLI::App& command, ReportOptions& options) {
  command
      .add_flag("--diagnose,!--no-diagnose", options.diagnose,
                "After a failure, name the probable mistake; default: on")
      ->group(option_group::reports);
  command
      .add_flag("-v,--verbose", options.verbose,
                "Show every failing case; default: the first of each group")
      ->group(option_group::reports);
  for (const ReportFormat& format : report_formats()) {
    command.add_option(format.option, options.files[format.option], format.help)
        ->type_name("FILE")
        ->group(option_group::reports);
  }
  command
      .add_flag("--github", options.github,
                "Print annotations for GitHub Actions, and add to the job summary")
      ->group(option_group::reports);
}

void add_traces(CLI::App& command, RunOptions& options) {
  command
      .add_option("--save-traces", options.save_traces,
                  "Write the outputs of each failing vector (.got.csv), the expected outputs "
                  "(.want.csv) and, except at the level events, the tolerances (.tolerance.csv) "
                  "to this new folder")
      ->type_name("DIR")
      ->group(option_group::reports);
  command.get_option("--write-expected")->excludes(command.get_option("--expected-failures"));
}

}  // namespace

void add_run_command(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand(
      "run", "Run the cases on a port, and compare its outputs with the expected ones");
  add_port(*command, globals, options->host, Ports::any);
  add_selection(*command, options->select);
  command->add_option("--shard", options->select.shard, "Run only part I of N of the cases")
      ->type_name("I/N")
      ->capture_default_str()
      ->group(option_group::selection);
  command
      ->add_option("--rerun-failed", options->select.rerun_failed,
                   "Run only the vectors that failed in this JSON report; give the same --level "
                   "and --param as in that run")
      ->type_name("REPORT")
      ->group(option_group::selection);
  command
      ->add_option("--timing", options->timing,
                   "Run only the flight of this file from --record-timing, at the recorded times")
      ->type_name("F")
      ->group(option_group::selection);
  add_strictness(*command, *options);
  add_execution(*command, *options);
  add_reports(*command, options->report);
  add_traces(*command, *options);
  add_examples(
      *command,
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
  command->callback([options, &globals, &action] {
    // Goldens of earlier runs may be there.
    if (!options->save_traces.empty()) globals.barrier->hidden.push_back(options->save_traces);
    action = [=, &globals] { return run_command(*options, globals); };
  });
}

void add_merge_command(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<MergeOptions>();
  CLI::App* command = app.add_subcommand("merge", "Join the JSON reports of the shards of a run");
  command->add_option("reports", options->files, "The reports of all shards, in any order")
      ->type_name("REPORT")
      ->required();
  command
      ->add_option("--port", options->port,
                   "Port that the diagnosis runs; default: the port of the reports")
      ->type_name("PORT");
  add_jobs(*command, options->jobs, "Number of worker processes for the diagnosis");
  add_timeout(*command, options->timeout_s);
  add_reports(*command, options->report);
  add_examples(*command, {{"attest run --port lib:./libmine.so --shard 1/4 --json part1.json",
                           "run the first of four shards"},
                          {"attest merge part*.json --json attest.json --junit attest.junit.xml",
                           "join the reports of all shards"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return merge_command(*options, globals); };
  });
}

}  // namespace attest::cli
