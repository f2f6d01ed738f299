#include "harness/cli/suite_arguments.hpp"

#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "harness/cli/command.hpp"

namespace attest::cli {
namespace {

void add_faults(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<FaultOptions>();
  CLI::App* command =
      app.add_subcommand("faults", "Measure which faults of the catalogue the suite catches");
  CLI::Option* const ids =
      command->add_option("fault", options->ids, "Only these faults; default: all")
          ->type_name("ID");
  command
      ->add_option("--profile", options->profiles,
                   "Only these versions of the law, separated by commas; default: all")
      ->type_name("PROFILE")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_flag("--list", options->list, "List the faults, and run nothing");
  CLI::Option* const bits =
      command
          ->add_option("--fraction-bits", options->fraction_bits,
                       "Use the tolerances of a port in fixed point with this number of fraction "
                       "bits; default: those of floating point")
          ->check(CLI::Range(20, 32));
  CLI::Option* const level =
      command
          ->add_option(
              "--level", options->level,
              "Judge all cases at this level, exact, numeric or events, and print how many "
              "faults it catches; default: numeric, and exact for the cases that are "
              "compared at that level only")
          ->type_name("LEVEL");
  command
      ->add_flag(
          "--diagnose", options->diagnose,
          "Measure instead which faults the diagnosis names, and for which the reports name the "
          "stage")
      ->excludes(bits, ids, level);
  add_jobs(*command, options->jobs, "Number of faults that run at the same time");
  add_examples(*command, {{"attest faults", "measure which faults the open-loop cases catch"},
                          {"attest faults --level events tpa-missing", "the same at one level"},
                          {"attest faults --list --profile px4-v1.3.4",
                           "list the catalogue of one version of the law"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return faults_command(*options, globals); };
  });
}

void add_list(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<ListOptions>();
  CLI::App* command =
      app.add_subcommand("list", "List the cases with their reasons, or another table");
  add_selection(*command, options->select);
  command->add_flag("--groups", options->groups,
                    "List the groups with their numbers of cases and vectors");
  command->add_flag("--parameters", options->parameters, "List the parameters of the law");
  command->add_flag("--channels", options->channels,
                    "List the signals (columns of traces) with type, unit and module");
  command->add_flag("--flight-modes", options->modes,
                    "List the flight modes and the flags that they set");
  command->add_flag("--vehicles", options->vehicles, "List the vehicles with their main data");
  add_examples(*command,
               {{"attest list --filter 'tpa/*'", "list the cases of a group with their reasons"},
                {"attest list --parameters --profile px4-v1.3.4",
                 "list the parameters of one version of the law"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return list_command(*options, globals); };
  });
}

// Options of the case that is made of a log.
void add_from_log(CLI::App& command, VectorOptions& options) {
  CLI::Option* const log =
      command
          .add_option(
              "--from-log", options.from_log,
              "Make a case from this flight log in the suite DIR instead; of v1.14 to v1.16, "
              "a case of each unit")
          ->type_name("FLIGHT.ulg")
          ->group(option_group::logs);
  const auto add_time = [&](const char* name, auto& value, const char* what) {
    command.add_option(name, value, what)
        ->type_name("S")
        ->check(CLI::NonNegativeNumber)
        ->needs(log)
        ->group(option_group::logs);
  };
  add_time("--from", options.from_s,
           "Begin at this time after the first step in the log [s]; default: 0");
  add_time("--to", options.to_s,
           "End before this time after the first step in the log [s]; default: the end of "
           "the log");
  add_assumed(command, options.assumed);
  command.get_option("--assume")->needs(log);
  for (const char* other :
       {"--lint", "--format", "--fixed-step", "--filter", "--exclude", "--group", "--rate"}) {
    log->excludes(command.get_option(other));
  }
}

void add_vectors(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<VectorOptions>();
  CLI::App* command = app.add_subcommand(
      "vectors", "Write the inputs of the vectors to files, for a port that attest cannot start");
  CLI::Option* const folder =
      command
          ->add_option("folder", options->folder,
                       "Folder for the files; with --from-log, the folder of the suite")
          ->type_name("DIR");
  CLI::Option* const lint = command->add_flag(
      "--lint", options->lint,
      "Write no files; report vectors so near to a threshold of the law that correct "
      "ports may differ");
  lint->excludes(folder);
  command->add_option("--format", options->format, "Format of the files: `csv` or `mat` (MATLAB)")
      ->type_name("FORMAT")
      ->capture_default_str()
      ->excludes(lint);
  command
      ->add_option("--fixed-step", options->fixed_step,
                   "Only vectors at this rate whose ticks are one period apart; their timestamps "
                   "are changed to begin at one period; default: all vectors, unchanged")
      ->type_name("HZ")
      ->excludes(lint);
  add_selection(*command, options->select, Selects::open_loop);
  add_from_log(*command, *options);
  add_examples(
      *command,
      {{"attest vectors DIR --group attitude --rate 250", "write the inputs of some cases"},
       {"attest vectors DIR --format mat --fixed-step 250",
        "write all vectors that a Simulink model with a sample time of 4 ms can run"},
       {"attest vectors ours --from-log flight.ulg --from 10 --to 20",
        "make a case from ten seconds of a flight, in the suite `ours`"},
       {"attest vectors --lint",
        "report vectors for which rounding decides at a threshold of the law"}});
  command->callback([options, &globals, &action] {
    if (!options->lint && options->folder.empty()) throw CLI::RequiredError("folder");
    action = [=, &globals] {
      if (options->lint) return lint_command(*options, globals);
      return options->from_log.empty() ? vectors_command(*options, globals)
                                       : vectors_from_log_command(*options, globals);
    };
  });
}

void add_bless(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<BlessOptions>();
  CLI::App* command = app.add_subcommand(
      "bless", "Make new golden traces from the reference, after showing the changes");
  add_selection(*command, options->select);
  // Hidden: bless_command() refuses it, and says what to use instead.
  command->get_option("--exclude")->group("");
  command
      ->add_option("--reason", options->reason,
                   "Reason of the change, which is stored in provenance.toml (required)")
      ->type_name("TEXT");
  command->add_flag("--yes", options->yes, "Replace the goldens without a question");
  command
      ->add_option("--port", options->port,
                   "Make the goldens of --suite DIR from this port; default: from the reference "
                   "of attest")
      ->type_name("PORT");
  options->host.barrier = globals.barrier;
  add_timeout(*command, options->host.timeout_s);
  add_examples(*command, {{"attest bless --filter 'px4-v1.5.5/tpa/*' --reason \"...\"",
                           "show the changes, and ask before the goldens are replaced"},
                          {"attest bless --suite ours --port lib:./ours.so --reason \"our law\"",
                           "make the goldens of the suite `ours` from your own law"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return bless_command(*options, globals); };
  });
}

}  // namespace

void add_suite_commands(CLI::App& app, const Globals& globals, Action& action) {
  add_faults(app, globals, action);
  add_list(app, globals, action);
  add_vectors(app, globals, action);
  add_bless(app, globals, action);
}

}  // namespace attest::cli
