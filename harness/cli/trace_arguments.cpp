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
      .add_option("--within", options.log_limits.within,
                  "Largest difference from a logged value that counts as agreement, in the unit "
                  "of the signal")
      ->type_name("X")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber)
      ->group(option_group::logs);
  command
      .add_option("--at-least", options.log_limits.least_part_within,
                  "Part of the compared samples of a log that must agree")
      ->type_name("PART")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0))
      ->group(option_group::logs);
}

// Options that choose the law by which the port is judged.
void add_law_options(CLI::App& command, ReplayOptions& options) {
  command
      .add_option("--profile", options.profile,
                  "Version of the law; default for a trace: that of its provenance.toml, else "
                  "the newest with its unit; default for a log: the release of PX4 that wrote it")
      ->type_name("PROFILE");
  command
      .add_option("--param", options.parameters,
                  "Set a parameter of the port from the first step on")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  command
      .add_option("--level", options.level,
                  "How outputs are compared: `exact`, `numeric` or `events`")
      ->type_name("LEVEL")
      ->capture_default_str();
  command
      .add_option("--mixer", options.mixer,
                  "Mixer definition of a mixer trace; default: that of its provenance.toml, else "
                  "the geometry in the file name (4x.csv)")
      ->type_name("TEXT");
}

void add_replay(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand("replay",
                                         "Feed the inputs of recorded traces or flight logs to a "
                                         "port and compare its outputs with the recorded ones");
  command->add_option("files", options->files, "Traces (CSV) or flight logs (.ulg)")
      ->type_name("FILE")
      ->required();
  add_port(*command, globals, options->host);
  add_law_options(*command, *options);
  add_log_options(*command, *options);
  add_page(*command, options->html,
           "a page with plots of the outputs; needs a single trace or log");
  command->add_option("--json", options->json, "Write the result of each trace and unit as JSON")
      ->type_name("F.json")
      ->group(option_group::reports);
  add_timeout(*command, options->host.timeout_s);
  add_examples(*command, {{"attest replay TRACE.csv --port lib:./libmine.so",
                           "compare a port with a recorded trace"},
                          {"attest replay TRACE.csv --param MC_ROLL_P=7",
                           "compare the reference with another value of a parameter"},
                          {"attest replay FLIGHT.ulg --port lib:./libmine.so",
                           "compare a port with the log of a flight"}});
  command->callback([options, &globals, &action] {
    // The outputs in these files are what the port must compute.
    auto& hidden = globals.barrier->hidden;
    hidden.insert(hidden.end(), options->files.begin(), options->files.end());
    action = [=, &globals] { return replay_command(*options, globals); };
  });
}

void add_record(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<RecordOptions>();
  CLI::App* command = app.add_subcommand(
      "record", "Write the inputs and outputs of a port in one open-loop case as a trace");
  command->add_option("case", options->case_name, "The case: its name or id, or a case file")
      ->type_name("CASE")
      ->required();
  command->add_option("--rate", options->rate, "The loop rate [Hz]")->type_name("HZ")->required();
  add_port(*command, globals, options->host);
  command
      ->add_option("--out", options->out,
                   "Write the trace as CSV, or as a ULog if the name ends with .ulg; `-` is stdout")
      ->type_name("F")
      ->capture_default_str();
  add_timeout(*command, options->host.timeout_s);
  add_examples(*command,
               {{"attest record px4-v1.5.5/rates/p_alone --rate 250 --port lib:./libmine.so --out "
                 "mine.csv",
                 "write a trace for `attest plot`, `replay` or `compare`"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return record_command(*options, globals); };
  });
}

void add_compare(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command = app.add_subcommand("compare", "Compare two traces or flight logs");
  command->add_option("got", options->got, "The trace (CSV) or flight log (.ulg) to judge")
      ->type_name("A")
      ->required();
  command->add_option("want", options->want, "The trace or flight log with the expected values")
      ->type_name("B")
      ->required();
  command
      ->add_option("--level", options->level,
                   "How outputs are compared: `exact`, `numeric` or `events`")
      ->type_name("LEVEL")
      ->capture_default_str();
  command->add_flag("--by-time", options->by_time,
                    "Compare all common signals at equal times; default: only if A or B is a log");
  command
      ->add_option("--tolerance", options->others,
                   "By time: allowed difference of signals other than the controller's outputs")
      ->type_name("X")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command
      ->add_option("--shift", options->shift,
                   "By time: move A earlier by this time [us] before the comparison; `auto` "
                   "estimates it")
      ->type_name("US")
      ->capture_default_str();
  add_page(*command, options->html,
           "a page with plots of the signals that differ; only for a comparison by time");
  add_examples(*command,
               {{"attest compare flown.csv reference.csv", "compare the outputs tick by tick"},
                {"attest compare flown.ulg reference.csv --tolerance 1e-3",
                 "compare all common signals at equal times"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return compare_command(*options, globals); };
  });
}

void add_plot(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<PlotOptions>();
  CLI::App* command =
      app.add_subcommand("plot", "Plot signals of traces and flight logs on one page");
  command
      ->add_option("files", options->files,
                   "CSV files with a column `timestamp` [us], or flight logs (.ulg)")
      ->type_name("TRACE")
      ->required();
  command
      ->add_option("--channels", options->signals,
                   "Only signals whose name matches one of these shell patterns; default: the "
                   "controller's outputs, else all, up to 100")
      ->type_name("GLOB,...")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_flag("--list", options->list, "List the signals, and write no page");
  command
      ->add_option(
          "--html", options->html,
          "Write this page; default: that of the first file, with .html as its ending, in the "
          "current folder")
      ->type_name("F.html")
      ->group(option_group::reports);
  add_examples(*command, {{"attest plot flown.csv flight.ulg --channels 'control_state.*_rate'",
                           "plot the body rates of two flights"},
                          {"attest plot flight.ulg --list", "list the signals of a log"}});
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
