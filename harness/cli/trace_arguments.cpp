#include "harness/cli/trace_arguments.hpp"

#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "harness/cli/command.hpp"

namespace attest::cli {
namespace {

void add_log_options(CLI::App& command, ReplayOptions& options) {
  add_assumed(command, options.assumed);
  command
      .add_option(
          "--within", options.log_limits.within,
          "Largest difference from a log that counts as agreement, in the unit of the signal")
      ->type_name("X")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber)
      ->group(option_group::logs);
  command
      .add_option("--at-least", options.log_limits.least_part_within,
                  "The part of a log's samples that must agree")
      ->type_name("PART")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0))
      ->group(option_group::logs);
}

// Options that choose the law by which the port is judged.
void add_law_options(CLI::App& command, ReplayOptions& options) {
  command
      .add_option(
          "--profile", options.profile,
          "Version of the law. Default for a trace: that of the provenance.toml next to it, else "
          "the newest version that has the unit of the trace; for a log: the release of PX4 that "
          "wrote it. A log of attitude unit and rate unit that does not name its release needs "
          "this option")
      ->type_name("PROFILE");
  command.add_option("--param", options.parameters, "Set a parameter from the first step on")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  command.add_option("--level", options.level, "`exact`, `numeric` or `events`")
      ->type_name("LEVEL")
      ->capture_default_str();
  command
      .add_option("--mixer", options.mixer,
                  "Definition of the mixer of a mixer trace; default: that of the provenance.toml "
                  "next to the trace, else the geometry in the file name (`4x.csv`)")
      ->type_name("TEXT");
}

void add_replay(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand("replay",
                                         "Feed the inputs of recorded traces or flight logs to a "
                                         "port and compare its outputs with the recorded ones");
  command
      ->add_option(
          "files", options->files,
          "Traces (CSV) of a controller, a unit of it, a mixer or a battery estimate; logs "
          "of flights (.ulg) of v1.3.4, v1.5.5 and v1.14 to v1.16: a logged output is "
          "compared if the log also has the sample from which it was computed "
          "(control_state, vehicle_attitude, vehicle_angular_velocity)")
      ->type_name("FILE")
      ->required();
  add_port(*command, options->host.port);
  add_law_options(*command, *options);
  add_log_options(*command, *options);
  add_page(*command, options->html, "A page with plots of the outputs, of one trace or log");
  command->add_option("--json", options->json, "Write the results, by trace and unit")
      ->type_name("F.json")
      ->group(option_group::reports);
  add_timeout(*command, options->host.timeout_s);
  add_examples(*command, {{"attest replay TRACE.csv --port lib:./libmine.so",
                           "a trace recorded from the firmware, or written by `attest sim`"},
                          {"attest replay TRACE.csv --param MC_ROLL_P=7",
                           "with another value of a parameter"},
                          {"attest replay FLIGHT.ulg --port lib:./libmine.so",
                           "how well the port agrees with what flew"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return replay_command(*options, globals); };
  });
}

void add_record(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<RecordOptions>();
  CLI::App* command = app.add_subcommand(
      "record", "Write the trace of a port in one open-loop case: its inputs and outputs");
  command->add_option("case", options->case_name, "The case: its name, its id or its file")
      ->type_name("CASE")
      ->required();
  command->add_option("--rate", options->rate, "The loop rate [Hz]")->type_name("HZ")->required();
  add_port(*command, options->host.port);
  command
      ->add_option("--out", options->out,
                   "The trace: CSV, or a ULog of PX4 if the name ends with .ulg; `-` is stdout, "
                   "as CSV")
      ->type_name("F")
      ->capture_default_str();
  add_timeout(*command, options->host.timeout_s);
  add_examples(*command,
               {{"attest record px4-v1.5.5/rates/p_alone --rate 250 --port lib:./libmine.so --out "
                 "mine.csv",
                 "for a plot, or for `attest replay` and `attest compare`"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return record_command(*options, globals); };
  });
}

void add_compare(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand("compare", "Compare two traces or logs of flights");
  command
      ->add_option("got", options->got,
                   "The trace to judge: CSV, or a log (.ulg). Two traces of attest are compared "
                   "tick by tick, in their outputs; with a log, all signals at equal times")
      ->type_name("A")
      ->required();
  command
      ->add_option("want", options->want,
                   "The trace or log with the expected values; outputs that it lacks are named and "
                   "not compared")
      ->type_name("B")
      ->required();
  command->add_option("--level", options->level, "`exact`, `numeric` or `events`")
      ->type_name("LEVEL")
      ->capture_default_str();
  command->add_flag("--by-time", options->by_time,
                    "Compare all signals at equal times, as with a log; for CSV files of any "
                    "origin with a column timestamp [us]");
  command
      ->add_option("--tolerance", options->others,
                   "By time: allowed difference of signals other than the controller's outputs. "
                   "The outputs have the tolerances of the level")
      ->type_name("X")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      ->add_option("--shift", options->shift,
                   "By time: before the comparison, move A earlier by this time [us]; `auto`: by "
                   "the estimated lag")
      ->type_name("US")
      ->capture_default_str();
  add_page(*command, options->html, "By time: a page with plots of the signals that differ");
  add_examples(*command, {{"attest compare flown.csv reference.csv",
                           "is the first the same as the second, within the tolerances?"},
                          {"attest compare flown.ulg reference.csv --tolerance 1e-3",
                           "all signals at equal times, and by how much one file is late"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return compare_command(*options, globals); };
  });
}

void add_plot(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<PlotOptions>();
  CLI::App* command =
      app.add_subcommand("plot", "Plot signals of traces and logs of flights, on one page");
  command
      ->add_option("files", options->files,
                   "CSV files with a column `timestamp` [us], or logs (.ulg); signals of the same "
                   "name share a plot")
      ->type_name("TRACE")
      ->required();
  command
      ->add_option("--channels", options->signals,
                   "Only signals whose name matches one of these shell patterns, such as "
                   "'vehicle_rates_setpoint.*'; default: the controller's outputs, else all, up to "
                   "100")
      ->type_name("GLOB,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_flag("--list", options->list, "List the signals; write nothing");
  command
      ->add_option("--html", options->html,
                   "The page; it needs no network. Default: the name of the first file, with "
                   ".html, in this folder")
      ->type_name("F.html")
      ->group(option_group::reports);
  add_examples(*command, {{"attest plot flown.csv flight.ulg --channels 'control_state.*_rate'",
                           "the rates of two flights"},
                          {"attest plot flight.ulg --list", "the signals of a log"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return plot_command(*options, globals); };
  });
}

}  // namespace

void add_trace_commands(CLI::App& app, const Globals& globals, Action& action) {
  add_replay(app, globals, action);
  add_record(app, globals, action);
  add_compare(app, globals, action);
  add_plot(app, globals, action);
}

}  // namespace attest::cli
