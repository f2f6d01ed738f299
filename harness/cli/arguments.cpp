#include "harness/cli/arguments.hpp"

#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "harness/cli/command.hpp"
#include "harness/cli/run_arguments.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/suite_arguments.hpp"
#include "harness/cli/timing_arguments.hpp"
#include "harness/cli/wrong_arguments.hpp"
#include "harness/core/version.hpp"

namespace attest::cli {
namespace {

constexpr const char* description =
    "Judges whether a port of the PX4 multicopter attitude controller conforms to the\n"
    "reference at every loop rate. Reports the first divergence: its tick, signal and stage of the "
    "law.\n";

constexpr const char* footer =
    "\nFirst steps (`attest help COMMAND` has more):\n"
    "  attest run                                     the built-in reference, all cases and rates\n"
    "  attest run --port lib:./libmine.so             your port\n"
    "  attest run --port lib:./libmine.so --level exact --filter 'attitude/*@250hz'\n"
    "  attest replay TRACE.csv --port lib:./libmine.so\n"
    "  attest sim hover --rate 250 --port lib:./libmine.so --out flown.csv\n"
    "  attest stress --port lib:./libmine.so          in real time, at 250 Hz to 8 kHz\n"
    "\n"
    "Exit codes: 0 no failure, 1 a failure, 2 wrong usage or environment.\n";

void add_replay(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<ReplayOptions>();
  CLI::App* command = app.add_subcommand("replay",
                                         "Feed the inputs of recorded traces to a port and compare "
                                         "its outputs with the recorded ones");
  command
      ->add_option("files", options->files,
                   "Traces (CSV) of a controller, a mixer or a battery estimate")
      ->type_name("TRACE")
      ->required();
  add_port(*command, options->host.port);
  command
      ->add_option(
          "--profile", options->profile,
          "Version of the law; default: that of the provenance.toml next to the trace, else "
          "px4-v1.5.5")
      ->type_name("PROFILE");
  command->add_option("--param", options->parameters, "Set a parameter from the first step on")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  command->add_option("--level", options->level, "`exact`, `numeric` or `events`")
      ->capture_default_str();
  command
      ->add_option("--mixer", options->mixer,
                   "Definition of the mixer of a mixer trace; default: that of the provenance.toml "
                   "next to the trace, else the geometry in the file name (`4x.csv`)")
      ->type_name("TEXT");
  add_timeout(*command, options->host.timeout_s);
  add_examples(*command, {{"attest replay TRACE.csv --port lib:./libmine.so",
                           "a trace recorded from the firmware, or written by `attest sim`"},
                          {"attest replay TRACE.csv --param MC_ROLL_P=7",
                           "with another value of a parameter"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return replay_command(*options, globals); };
  });
}

void add_sim(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<SimOptions>();
  CLI::App* command = app.add_subcommand(
      "sim", "Let a port fly one case, and write the trace of the flight, for `attest replay`");
  command->add_option("case", options->case_name, "A flight: its name or id, or a case file")
      ->type_name("CASE");
  command
      ->add_option("--rate", options->rate, "Loop rate [Hz]; also one that the case does not list")
      ->type_name("HZ");
  command
      ->add_option("--timing", options->timing,
                   "Instead of a case and a rate: the flight of `stress --record-timing`, at the "
                   "recorded times")
      ->type_name("F");
  add_plant(*command, options->vehicle, options->plant);
  command->get_option("--plant")->description(
      "`mujoco` or `ode`; default: the case's first; `all`: the same flight on each, for --html");
  add_port(*command, options->host.port);
  command
      ->add_option("--out", options->out,
                   "The flown trace: CSV, or a ULog of PX4 if the name ends with .ulg; `-` is "
                   "stdout, as CSV")
      ->type_name("F");
  add_page(*command, options->html, "A page with plots of the flight and a replay of the attitude");
  add_timeout(*command, options->host.timeout_s);
  add_examples(*command, {{"attest sim hover --rate 250 --port lib:./libmine.so --out flown.csv",
                           "hover with the lead vehicle of the case, on its first plant"},
                          {"attest sim gust --rate 500 --vehicle hexa --plant ode --out flown.csv",
                           "another vehicle on the other plant"},
                          {"attest sim flip_150_level --rate 250 --html flight.html",
                           "the flight as a page with plots"},
                          {"attest sim gust --rate 250 --plant all --html flight.html",
                           "the flights on both plants in the same plots"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return sim_command(*options, globals); };
  });
}

void add_compare(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command =
      app.add_subcommand("compare", "Compare the outputs of two traces, tick by tick");
  command->add_option("got", options->got, "The trace to judge (CSV)")->type_name("A")->required();
  command->add_option("want", options->want, "The trace to judge it by (CSV)")
      ->type_name("B")
      ->required();
  command->add_option("--level", options->level, "`exact`, `numeric` or `events`")
      ->capture_default_str();
  add_examples(*command, {{"attest compare flown.csv reference.csv",
                           "is the first the same as the second, within the tolerances?"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return compare_command(*options, globals); };
  });
}

void add_doctor(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<DoctorOptions>();
  CLI::App* command = app.add_subcommand(
      "doctor", "Check the machine, the suite, the reference and a port, and report errors");
  add_port(*command, options->host.port);
  add_timeout(*command, options->host.timeout_s);
  add_examples(*command, {{"attest doctor --port lib:./libmine.so",
                           "the machine, the suite, the reference and your port"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return doctor_command(*options, globals); };
  });
}

void add_smoke(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<SmokeOptions>();
  CLI::App* command = app.add_subcommand(
      "smoke",
      "Check step by step whether a new port keeps the rules of attest_unit.h, or of "
      "harness/port/PROTOCOL.md if it is a program, before any law is compared");
  add_port(*command, options->host.port);
  add_timeout(*command, options->host.timeout_s);
  add_examples(*command,
               {{"attest smoke --port \"proc:python3 my_port.py\"", "the exchange with a program"},
                {"attest smoke --port lib:./libmine.so", "the functions of a shared library"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return smoke_command(*options, globals); };
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
  add_examples(*command, {{"attest record rates/p_alone --rate 250 --port lib:./libmine.so --out "
                           "mine.csv",
                           "for a plot, or for `attest replay` and `attest compare`"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return record_command(*options, globals); };
  });
}

void add_new_port(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<NewPortOptions>();
  CLI::App* command = app.add_subcommand(
      "new-port", "Make a folder with a complete port, to be changed into yours, and its CI jobs");
  command->add_option("folder", options->folder, "The new folder")->type_name("DIR")->required();
  command
      ->add_option("--lang", options->language,
                   "`c`, `cpp`, `numpy`, `python`, `rust` or `simulink`")
      ->type_name("LANG")
      ->required();
  add_examples(
      *command,
      {{"attest new-port mine --lang c", "a port in C; mine/check builds and runs it"},
       {"attest new-port mine --lang simulink", "a wrapper for C code that Simulink generated"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return new_port_command(*options, globals); };
  });
}

int show_help(const CLI::App& app, const std::string& name) {
  if (name.empty()) {  // app.help() would be that of this command
    fmt::print("{}",
               app.get_formatter()->make_help(&app, app.get_name(), CLI::AppFormatMode::Normal));
    return exit_ok;
  }
  const std::string wrong = unknown_command(app, name);
  if (!wrong.empty()) return report_error({wrong});
  fmt::print("{}", app.get_subcommand(name)->help("attest"));
  return exit_ok;
}

void add_help(CLI::App& app, Action& action) {
  auto name = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("help", "Show the options and examples of a command");
  command->add_option("command", *name, "The command; default: an overview of all commands")
      ->type_name("COMMAND");
  add_examples(*command, {{"attest help run", "the same as `attest run --help`"}});
  command->callback(
      [name, &app, &action] { action = [=, &app] { return show_help(app, *name); }; });
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App app(description, "attest");
  use_plain_flag_names(app);
  app.set_version_flag("--version", fmt::format("attest {}", version));
  app.require_subcommand(1);
  app.fallthrough();

  Globals globals;
  app.add_option("--suite", globals.suite, "Folder with cases/, golden/ and models/")
      ->type_name("DIR");
  app.add_flag("-q,--quiet", globals.quiet, "No progress and no summary, only what went wrong");

  Action action;
  add_run_command(app, globals, action);
  add_merge_command(app, globals, action);
  add_replay(app, globals, action);
  add_sim(app, globals, action);
  add_timing_commands(app, globals, action);
  add_record(app, globals, action);
  add_compare(app, globals, action);
  add_suite_commands(app, globals, action);
  add_new_port(app, globals, action);
  add_doctor(app, globals, action);
  add_smoke(app, globals, action);
  add_help(app, action);
  app.footer(footer);  // last: commands copy the footer that exists when they are added

  const std::string word = argc > 1 ? argv[1] : "";
  if (!word.empty() && !word.starts_with('-')) {
    const std::string wrong = unknown_command(app, word);
    if (!wrong.empty()) return report_error({wrong});
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ExtrasError& error) {
    const std::string wrong = unknown_option(app, argc, argv);
    if (!wrong.empty()) return report_error({wrong});
    app.exit(error);
    return exit_usage;
  } catch (const CLI::ParseError& error) {
    app.exit(error);
    return exit_usage;
  }
  if (const std::string wrong = wrong_value(app); !wrong.empty()) return report_error({wrong});
  return action();
}

}  // namespace attest::cli
