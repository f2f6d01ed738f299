#include "harness/cli/arguments.hpp"

#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "harness/cli/command.hpp"
#include "harness/cli/run_arguments.hpp"
#include "harness/cli/shared_arguments.hpp"
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
  add_port(*command, options->host.port);
  command->add_option("--out", options->out, "The flown trace (CSV); `-` is stdout")
      ->type_name("F.csv")
      ->required();
  add_timeout(*command, options->host.timeout_s);
  add_examples(*command, {{"attest sim hover --rate 250 --port lib:./libmine.so --out flown.csv",
                           "hover with the lead vehicle of the case, on its first plant"},
                          {"attest sim gust --rate 500 --vehicle hexa --plant ode --out flown.csv",
                           "another vehicle on the other plant"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return sim_command(*options, globals); };
  });
}

void add_faults(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<FaultOptions>();
  CLI::App* command =
      app.add_subcommand("faults", "Measure the suite: which faults of the catalogue it catches");
  CLI::Option* const ids =
      command->add_option("fault", options->ids, "Only these faults")->type_name("ID");
  command
      ->add_option("--profile", options->profiles, "Only this version of the law (cases, faults)")
      ->type_name("PROFILE")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_flag("--list", options->list, "List the catalogue; run nothing");
  CLI::Option* const bits =
      command
          ->add_option("--fraction-bits", options->fraction_bits,
                       "Use the tolerances of a port in fixed point with so many fraction bits")
          ->check(CLI::Range(20, 32));
  command
      ->add_flag("--diagnose", options->diagnose,
                 "Measure the diagnosis instead: is each fault recognised?")
      ->excludes(bits, ids);
  add_jobs(*command, options->jobs, "Faults at a time");
  add_examples(*command, {{"attest faults", "which faults the whole suite catches"},
                          {"attest faults --list --profile px4-v1.3.4",
                           "the catalogue of one version of the law"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return faults_command(*options, globals); };
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

void add_vectors(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<VectorOptions>();
  CLI::App* command = app.add_subcommand(
      "vectors",
      "Write the inputs of the vectors to files, for a port that attest cannot call; `attest run "
      "--port recorded:DIR` judges its outputs");
  CLI::Option* const folder =
      command
          ->add_option("folder", options->folder,
                       "Where: DIR/PROFILE/GROUP/NAME/RATEhz.csv, with DIR/manifest.toml")
          ->type_name("DIR");
  CLI::Option* const lint = command->add_flag(
      "--lint", options->lint,
      "Write nothing; report numeric vectors that are too near to a decision of the law, "
      "where correct controllers may differ");
  lint->excludes(folder);
  command->add_option("--format", options->format, "`csv`, `mat` (MATLAB) or `npy` (numpy)")
      ->type_name("FORMAT")
      ->capture_default_str()
      ->excludes(lint);
  command
      ->add_option("--fixed-step", options->fixed_step,
                   "For a port with a fixed sample time: only vectors with regular ticks at this "
                   "rate, from one period after zero on")
      ->type_name("HZ")
      ->excludes(lint);
  add_selection(*command, options->select);
  add_examples(
      *command,
      {{"attest vectors DIR --group attitude --rate 250", "the inputs of some cases, a file each"},
       {"attest vectors DIR --format mat --fixed-step 250",
        "all that a Simulink model with a sample time of 4 ms can run"},
       {"attest vectors --lint", "is a vector too near to a decision of the law?"}});
  command->callback([options, &globals, &action] {
    if (!options->lint && options->folder.empty()) throw CLI::RequiredError("folder");
    action = [=, &globals] {
      return options->lint ? lint_command(*options, globals) : vectors_command(*options, globals);
    };
  });
}

void add_list(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<ListOptions>();
  CLI::App* command =
      app.add_subcommand("list", "List the cases with their reasons, or one of the tables");
  add_selection(*command, options->select);
  command->add_flag("--groups", options->groups,
                    "Only the groups, with their numbers of cases and vectors");
  command->add_flag("--parameters", options->parameters, "The parameters of the law");
  command->add_flag("--channels", options->channels, "The signals: trace columns and ABI members");
  command->add_flag("--flight-modes", options->modes, "Flight modes and the flags they set");
  command->add_flag("--vehicles", options->vehicles, "The vehicles, with mass, rotors, arm, ...");
  add_examples(*command,
               {{"attest list --filter 'tpa/*'", "the cases of a group, with their reasons"},
                {"attest list --parameters --profile px4-v1.3.4",
                 "the parameters of one version of the law"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return list_command(*options, globals); };
  });
}

void add_bless(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<BlessOptions>();
  CLI::App* command = app.add_subcommand(
      "bless",
      "Make new golden traces from the reference, after showing the changes; one process at a time "
      "(golden/.bless.lock)");
  add_selection(*command, options->select);
  command->add_option("--reason", options->reason, "Why, for provenance.toml (required)")
      ->type_name("TEXT");
  command->add_flag("--yes", options->yes, "Do not ask");
  add_examples(*command, {{"attest bless --filter 'px4-v1.5.5/tpa/*' --reason \"...\"",
                           "shows the changes, and asks before it replaces the goldens"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return bless_command(*options, globals); };
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
  add_replay(app, globals, action);
  add_sim(app, globals, action);
  add_timing_commands(app, globals, action);
  add_compare(app, globals, action);
  add_faults(app, globals, action);
  add_list(app, globals, action);
  add_vectors(app, globals, action);
  add_bless(app, globals, action);
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
