#include "harness/cli/arguments.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "harness/cli/command.hpp"
#include "harness/cli/completion.hpp"
#include "harness/cli/man_page.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/run_arguments.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/suite_arguments.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/cli/timing_arguments.hpp"
#include "harness/cli/trace_arguments.hpp"
#include "harness/cli/wrong_arguments.hpp"
#include "harness/core/version.hpp"

namespace attest::cli {
namespace {

constexpr const char* description =
    "Tests whether a port of PX4's multicopter attitude and rate control behaves as the original\n"
    "does. The releases are v1.3.4, v1.5.5, v1.14.4, v1.15.4 and v1.16.0. The report names the\n"
    "first deviation: its tick, its signal and the stage of the law.\n";

constexpr const char* footer =
    "\nFirst steps (`attest help COMMAND` has more):\n"
    "  attest run                                     run all cases on the built-in reference\n"
    "  attest run --port lib:./libmine.so             run all cases on your port\n"
    "  attest run --port lib:./libmine.so --level exact --filter 'attitude/*@250hz'\n"
    "  attest replay TRACE.csv --port lib:./libmine.so\n"
    "  attest sim hover --rate 250 --port lib:./libmine.so --out flown.csv\n"
    "  attest sim hover --rate 250:1000 --out f.csv   fly both units of v1.14 to v1.16\n"
    "  attest stress --port lib:./libmine.so          fly in real time, at 250 Hz to 8 kHz\n"
    "\n"
    "Exit codes: 0 no failure, 1 a failure, 2 wrong usage or environment, or no result,\n"
    "130 interrupted by Ctrl-C.\n";

void add_sim(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<SimOptions>();
  CLI::App* command = app.add_subcommand(
      "sim",
      "Fly one case in simulation with a port, and write a trace or a page of the "
      "flight");
  command
      ->add_option("case", options->case_name,
                   "The flight: the name or id of a case, or a case file")
      ->type_name("CASE");
  command
      ->add_option("--rate", options->rate,
                   "Loop rate [Hz]; for v1.14 to v1.16 the rates of both units, such as 250:1000")
      ->type_name("HZ");
  command
      ->add_option("--timing", options->timing,
                   "Fly the flight of this file from --record-timing again, at the recorded "
                   "times; it replaces CASE, --rate, --vehicle and --plant")
      ->type_name("F");
  add_plant(*command, options->vehicle, options->plant);
  command->get_option("--plant")->description(
      "Plant: `mujoco` or `ode`, or `all` for a page (--html) with the flights on "
      "both; default: the first plant of the case");
  add_port(*command, globals, options->host);
  command
      ->add_option("--out", options->out,
                   "Write the trace as CSV, or as a ULog if the name ends with .ulg; for v1.14 to "
                   "v1.16, F.csv has the rate unit and F.attitude_unit.csv the attitude unit")
      ->type_name("F");
  add_page(*command, options->html,
           "a page with plots of the flight and an animation of the attitude");
  add_timeout(*command, options->host.timeout_s);
  add_examples(*command, {{"attest sim hover --rate 250 --port lib:./libmine.so --out flown.csv",
                           "hover with the Iris on MuJoCo, and write a trace"},
                          {"attest sim gust --rate 500 --vehicle hexa --plant ode --out flown.csv",
                           "another vehicle and another plant"},
                          {"attest sim flip_150_level --rate 250 --html flight.html",
                           "the flight as a page with plots"},
                          {"attest sim gust --rate 250 --plant all --html flight.html",
                           "the flights on both plants in the same plots"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return sim_command(*options, globals); };
  });
}

void add_doctor(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<DoctorOptions>();
  CLI::App* command = app.add_subcommand(
      "doctor", "Check the machine, the suite, the reference and a port, and report errors");
  add_port(*command, globals, options->host);
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
      "Check step by step whether a port follows attest_unit.h, or PROTOCOL.md if it "
      "is a program; its law is not judged");
  add_port(*command, globals, options->host);
  add_timeout(*command, options->host.timeout_s);
  add_examples(*command,
               {{"attest smoke --port \"proc:python3 my_port.py\"", "the exchange with a program"},
                {"attest smoke --port lib:./libmine.so", "the functions of a shared library"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return smoke_command(*options, globals); };
  });
}

void add_new_port(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<NewPortOptions>();
  CLI::App* command = app.add_subcommand(
      "new-port", "Make a folder with a complete port to start from, and with CI jobs");
  command->add_option("folder", options->folder, "The new folder")->type_name("DIR")->required();
  command
      ->add_option("--lang", options->language,
                   "Port to start from: `c`, `cpp`, `python`, `rust` or `simulink` for v1.5.5 and "
                   "v1.3.4; `c_cascade` or `python_cascade` for v1.14 to v1.16")
      ->type_name("LANG")
      ->required();
  add_examples(
      *command,
      {{"attest new-port mine --lang c", "a port in C; mine/check builds and runs it"},
       {"attest new-port mine --lang c_cascade", "a port in C of v1.14 to v1.16"},
       {"attest new-port mine --lang simulink", "a wrapper for C code that Simulink generated"}});
  command->callback([options, &globals, &action] {
    action = [=, &globals] { return new_port_command(*options, globals); };
  });
}

struct HelpOptions {
  std::string command, completion, man;
};

int show_help(const CLI::App& app, const HelpOptions& options, const Globals& globals) {
  if (!options.man.empty()) {
    const auto apart = check_output_folder(options.man, globals.suite);
    if (!apart) return report_error(apart.error());
    const auto written = write_man_pages(app, options.man);
    return written ? exit_ok : report_error(written.error());
  }
  if (!options.completion.empty()) {
    const bool is_bash = options.completion == "bash";
    fmt::print("{}", is_bash ? bash_completion(app) : zsh_completion(app));
    return exit_ok;
  }
  if (options.command.empty()) {  // app.help() would give the help of the command `help`
    fmt::print("{}",
               app.get_formatter()->make_help(&app, app.get_name(), CLI::AppFormatMode::Normal));
    return exit_ok;
  }
  const std::string wrong = unknown_command(app, options.command);
  if (!wrong.empty()) return report_error({wrong});
  fmt::print("{}", app.get_subcommand(options.command)->help("attest"));
  return exit_ok;
}

void add_help(CLI::App& app, const Globals& globals, Action& action) {
  auto options = std::make_shared<HelpOptions>();
  CLI::App* command = app.add_subcommand("help", "Show the options and examples of a command");
  command->add_option("command", options->command, "The command; default: show all commands")
      ->type_name("COMMAND");
  command
      ->add_option("--completion", options->completion,
                   "Print the completion script for `bash` or `zsh`")
      ->type_name("KIND")
      ->check(CLI::IsMember({"bash", "zsh"}));
  command->add_option("--man", options->man, "Write the manual pages to this folder")
      ->type_name("DIR");
  add_examples(*command, {{"attest help run", "the same as `attest run --help`"},
                          {"source <(attest help --completion bash)",
                           "completion in this shell, unless the package installed it"}});
  command->callback([options, &app, &globals, &action] {
    action = [=, &app, &globals] { return show_help(app, *options, globals); };
  });
}

void add_commands(CLI::App& app, const Globals& globals, Action& action) {
  add_run_command(app, globals, action);
  add_merge_command(app, globals, action);
  add_sim(app, globals, action);
  add_timing_commands(app, globals, action);
  add_trace_commands(app, globals, action);
  add_suite_commands(app, globals, action);
  add_new_port(app, globals, action);
  add_doctor(app, globals, action);
  add_smoke(app, globals, action);
  add_help(app, globals, action);
  app.footer(footer);  // last: commands copy the footer that exists when they are added
}

// Returns the exit code if the command line is wrong, or only asks for help or the version. Empty:
// the command must run.
std::optional<int> parse(CLI::App& app, int argc, char** argv) {
  const std::string word = argc > 1 ? argv[1] : "";
  if (!word.empty() && !word.starts_with('-')) {
    const std::string wrong = unknown_command(app, word);
    if (!wrong.empty()) return report_error({wrong});
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  } catch (const CLI::ParseError& error) {
    // A missing command or argument is less helpful to name than a misspelt option.
    const bool is_about_option = dynamic_cast<const CLI::ValidationError*>(&error) != nullptr ||
                                 dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr;
    const std::string wrong = is_about_option ? "" : unknown_option(app, argc, argv);
    return report_error({wrong.empty() ? wrong_usage(app, error) : wrong});
  }
  if (const std::string wrong = wrong_value(app); !wrong.empty()) return report_error({wrong});
  return std::nullopt;
}

// Ports must see neither the chosen suite nor the one that attest comes with.
void hide_suites(const Globals& globals) {
  std::vector<std::filesystem::path> roots;
  if (const auto suite = find_suite(globals.suite)) {
    roots.push_back(suite->root);
    if (suite->base) roots.push_back(*suite->base);
  }
  if (const auto data = data_folder()) roots.push_back(*data);
  for (const std::filesystem::path& root : roots) {
    for (const char* part : {"cases", "golden"}) {
      globals.barrier->hidden.push_back((root / part).string());
    }
  }
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App app(description, "attest");
  use_plain_flag_names(app);
  app.set_version_flag("--version", fmt::format("attest {}", version));
  app.require_subcommand(1);
  app.fallthrough();
  Globals globals;
  app.add_option("--suite", globals.suite,
                 "Folder with cases/, golden/ and models/; default: ATTEST_SUITE, else the "
                 "suite that attest comes with")
      ->type_name("DIR");
  app.add_option("--port-reads", globals.barrier->readable,
                 "The port may read this file or folder although it is in the suite, which is "
                 "hidden from ports; may be given several times")
      ->type_name("PATH")
      ->allow_extra_args(false);
  app.add_flag("-q,--quiet", globals.quiet, "Print only failures and errors");
  Action action;
  add_commands(app, globals, action);
  const auto ended = parse(app, argc, argv);
  if (ended) return *ended;
  hide_suites(globals);
  return action();
}

}  // namespace attest::cli
