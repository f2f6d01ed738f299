#include "harness/cli/arguments.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "harness/cli/command.hpp"
#include "harness/cli/completion.hpp"
#include "harness/cli/man_page.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/cli/wrong_arguments.hpp"
#include "harness/core/suite_files.hpp"
#include "harness/core/version.hpp"
#include "harness/report/terminal.hpp"

namespace attest::cli {
namespace {

constexpr const char* description =
    "Tests whether a port of PX4's multicopter attitude and rate control behaves as the original\n"
    "does. The releases are v1.3.4, v1.5.5 and v1.14 to v1.18. The report names the first "
    "deviation:\n"
    "its tick, its signal and the stage of the law.\n";

constexpr const char* footer =
    "\nFirst steps (`attest help COMMAND` has more):\n"
    "  attest new-port mine --lang c                  make a folder with a complete port of "
    "v1.5.5\n"
    "                                                 (c_cascade: of v1.14 to v1.18)\n"
    "  mine/check                                     build it as mine/port.so, and run all cases\n"
    "  attest run mine/port.so --rate 250             run all cases at one rate\n"
    "  attest run mine/port.so --level exact --filter 'attitude/*@250hz'\n"
    "  attest sim hover mine/port.so                  fly it, and print the metrics\n"
    "  attest sim hover --rate 250:1000 --out f.csv   fly both units of v1.14 to v1.18\n"
    "  attest replay TRACE.csv --port mine/port.so    compare it with a recorded trace\n"
    "  attest stress mine/port.so                     fly in real time, at 250 Hz to 8 kHz\n"
    "\n"
    "Exit codes: 0 no failure, 1 a failure, 2 wrong usage or environment, or no result,\n"
    "130 interrupted by Ctrl-C.\n";

// Breaks the lines of a text at this width. A word that is longer has a line of its own.
std::string wrapped(std::string_view text, std::size_t width) {
  std::string out, line;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    if (!line.empty() && line.size() + 1 + word.size() > width) {
      out += line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + std::string(word);
  }
  return out + line;
}

// Breaks the lines on a terminal at its width. Shows the negation of a flag as `--no-stack`; CLI11
// shows `--no-stack{false}`.
class HelpFormat final : public CLI::Formatter {
 public:
  std::string make_option_desc(const CLI::Option* option) const override {
    return in_column(CLI::Formatter::make_option_desc(option));
  }

  std::string make_subcommand(const CLI::App* command) const override {
    std::stringstream out;
    CLI::detail::format_help(out, command->get_name(), in_column(command->get_description()),
                             get_column_width());
    return out.str();
  }

  std::string make_option_name(const CLI::Option* option, bool is_positional) const override {
    constexpr std::string_view value = "{false}";
    std::string name = CLI::Formatter::make_option_name(option, is_positional);
    const auto at = name.find(value);
    return at == std::string::npos ? name : name.erase(at, value.size());
  }

 private:
  // A description, next to the names.
  std::string in_column(const std::string& text) const {
    const auto width = static_cast<std::size_t>(terminal_style(stdout).width);
    return width > 2 * get_column_width() ? wrapped(text, width - get_column_width()) : text;
  }
};

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

void add_help(const CommandLine& line) {
  auto options = std::make_shared<HelpOptions>();
  const Command command = line.add("help", "Show the options and examples of a command");
  command.option("command", options->command, "The command; default: show all commands")
      .type("COMMAND");
  command
      .option("--completion", options->completion,
              "Print the completion script for `bash` or `zsh`")
      .type("KIND")
      .one_of({"bash", "zsh"});
  command.option("--man", options->man, "Write the manual pages to this folder").type("DIR");
  command.examples({{"attest help run", "the same as `attest run --help`"},
                    {"source <(attest help --completion bash)",
                     "completion in this shell, unless the package installed it"}});
  command.runs([options, line] { return show_help(line.app, *options, line.globals); });
}

// In the order of --help.
constexpr std::array every_command{
    add_run,      add_hunt,    add_merge,  add_sim,      add_stress,  add_sweep, add_sweep_rate,
    add_schedule, add_time,    add_replay, add_record,   add_compare, add_plot,  add_faults,
    add_list,     add_vectors, add_bless,  add_new_port, add_doctor,  add_smoke, add_help};

// The words of the command line, without the program. A port that stands in the place of the case
// is behind --port: `sim mine.so hover` is `sim --port mine.so hover`.
std::vector<std::string> words_in_order(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() < 2) return words;
  const auto commands =
      app.get_subcommands([&](const CLI::App* one) { return one->get_name() == words[0]; });
  if (commands.empty() || !is_port(words[1])) return words;
  for (const char* argument : {"case", "port"}) {
    if (commands.front()->get_option_no_throw(argument) == nullptr) return words;
  }
  words.insert(words.begin() + 1, "--port");
  return words;
}

// Returns the exit code if the command line is wrong, or only asks for help or the version. Empty:
// the command must run.
std::optional<int> parse(CLI::App& app, int argc, char** argv) {
  if (argc == 1) {
    fmt::print(stderr, "{}{}\nattest --help lists the commands.\n", description, footer);
    return exit_usage;
  }
  const std::string word = argc > 1 ? argv[1] : "";
  if (word == "version" && argc == 2) {
    fmt::print("attest {}\n", version);
    return exit_ok;
  }
  if (!word.empty() && !word.starts_with('-')) {
    const std::string wrong = unknown_command(app, word);
    if (!wrong.empty()) return report_error({wrong});
  }
  std::vector<std::string> words = words_in_order(app, argc, argv);
  std::ranges::reverse(words);  // as CLI11 takes them
  try {
    app.parse(std::move(words));
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
    if (const auto archive = archive_of(root); !archive.empty()) {
      globals.barrier->hidden.push_back(archive.string());
    }
    for (const char* part : {"cases", "golden", packed_suite}) {
      globals.barrier->hidden.push_back((root / part).string());
    }
  }
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App app(description, "attest");
  app.formatter(std::make_shared<HelpFormat>());  // first: commands copy it
  app.set_version_flag("--version", fmt::format("attest {}", version));
  app.require_subcommand(1);
  app.fallthrough();
  Globals globals;
  app.add_option("--suite", globals.suite,
                 "Folder with cases/, golden/ and models/, or a zip archive of it; default: "
                 "ATTEST_SUITE, else the "
                 "suite that attest comes with")
      ->type_name("DIR");
  app.add_option("--port-reads", globals.barrier->readable,
                 "The port may read this file or folder although it is in the suite, which is "
                 "hidden from ports; may be given several times")
      ->type_name("PATH")
      ->check([](const std::string& path) {
        std::error_code failed;
        return std::filesystem::exists(path, failed) || path.find(".zip/") != std::string::npos
                   ? std::string()
                   : fmt::format("there is no file or folder {}", path);
      })
      ->allow_extra_args(false);
  app.add_flag("-q,--quiet", globals.quiet, "Print only failures and errors");
  Action action;
  for (const auto add : every_command) add({app, globals, action});
  app.footer(footer);  // last: commands copy the footer that exists when they are added
  const auto ended = parse(app, argc, argv);
  if (ended) return *ended;
  globals.words.assign(argv + 1, argv + argc);
  globals.words.erase(std::ranges::find(globals.words, app.get_subcommands().front()->get_name()));
  if (!globals.suite.empty()) {
    // Also if the command reads no suite: else the barrier would hide another one.
    if (const auto suite = find_suite(globals.suite); !suite) return report_error(suite.error());
  }
  hide_suites(globals);
  const std::string wrong = wrong_port(app, globals);
  return wrong.empty() ? action() : report_error({wrong});
}

}  // namespace attest::cli
