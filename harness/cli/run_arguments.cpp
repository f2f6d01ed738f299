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
                  "How strictly: `exact` (float32 bits), `numeric` (a tolerance for each channel) "
                  "or `events` (the same events, at most one tick apart, and values that "
                  "differ by at most about half their size plus a small floor); "
                  "flights are judged the same way at each level")
      ->capture_default_str()
      ->group(option_group::strictness);
  command
      .add_option("--param", options.parameters,
                  "Set a parameter from the first step on, in each open-loop case, for port and "
                  "reference; without flights")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false)
      ->group(option_group::strictness);
  command
      .add_option("--expected-failures", options.expected_failures,
                  "Failures that are accepted, with reasons (TOML), by group or case; if "
                  "a listed case passes, the run fails")
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
                "Run the port in attest's own process, for a debugger or a sanitizer; the result "
                "is partial")
      ->group(option_group::execution);
}

void add_reports(CLI::App& command, RunOptions& options) {
  command
      .add_flag("--diagnose,!--no-diagnose", options.diagnose,
                "After a failure, name the faults of the catalogue that match it (on by default)")
      ->group(option_group::reports);
  for (const ReportFormat& format : report_formats()) {
    command.add_option(format.option, options.reports[format.option], format.help)
        ->type_name("FILE")
        ->group(option_group::reports);
  }
  command
      .add_option("--save-traces", options.save_traces,
                  "Write the traces of each failing vector to a new folder: "
                  "DIR/PROFILE/GROUP/NAME/CONFIGURATION.got.csv with the port's outputs, "
                  ".want.csv with the expected ones, .tolerance.csv with the allowed difference "
                  "of each value")
      ->type_name("DIR")
      ->group(option_group::reports);
  command.get_option("--write-expected")->excludes(command.get_option("--expected-failures"));
}

}  // namespace

void add_run_command(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand(
      "run", "Run a port through the cases and compare it with the golden traces");
  add_port(*command, options->host.port, Ports::any);
  add_selection(*command, options->select);
  command->add_option("--shard", options->select.shard, "Only part I of N of the cases")
      ->type_name("I/N")
      ->capture_default_str()
      ->group(option_group::selection);
  command
      ->add_option("--timing", options->timing,
                   "Only the flight of `stress --record-timing`, replayed at the recorded times "
                   "and compared with the reference at these times")
      ->type_name("F")
      ->group(option_group::selection);
  add_strictness(*command, *options);
  add_execution(*command, *options);
  add_reports(*command, *options);
  add_examples(
      *command,
      {{"attest run", "the built-in reference, all vectors"},
       {"attest run --port lib:./libmine.so", "your port"},
       {"attest run --port recorded:DIR",
        "outputs in files, for inputs that `attest vectors DIR` wrote"},
       {"attest run --port lib:./libmine.so --level exact --filter 'attitude/*@250hz'",
        "some vectors, to the bit"},
       {"attest run --port lib:./libmine.so --exclude 'flight*/*' --junit attest.junit.xml",
        "without the flights, with a report for CI"},
       {"attest run --port lib:./libmine.so --html attest.html",
        "a page with plots of what fails"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return run_command(*options, globals); };
  });
}

}  // namespace attest::cli
