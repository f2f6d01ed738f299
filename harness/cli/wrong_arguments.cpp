#include "harness/cli/wrong_arguments.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/casefile/select.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/core/file.hpp"
#include "harness/core/suggestion.hpp"
#include "harness/core/suite_files.hpp"
#include "harness/report/text.hpp"

namespace attest::cli {
namespace {

// What other commands have, with what this command has instead. An empty word is any argument.
struct Elsewhere {
  std::string_view command, word, instead;
};
constexpr std::array elsewhere{
    Elsewhere{"list", "faults", "; `attest faults --list` lists them"},
    Elsewhere{"list", "--faults", "; `attest faults --list` lists them"},
    Elsewhere{"list", "--case", "; --filter chooses cases"},
    Elsewhere{"list", "", "; --group and --filter choose cases"},
    Elsewhere{"run", "--case", "; --filter chooses cases"},
    Elsewhere{"run", "", "; --filter chooses cases"},
    Elsewhere{"time", "--case", "; --filter chooses cases"},
    Elsewhere{"vectors", "--case", "; --filter chooses cases"},
    Elsewhere{"stress", "", "; --case chooses the flight"},
    Elsewhere{"plot", "--signal", "; --channels chooses signals"},
    Elsewhere{"plot", "--signals", "; --channels chooses signals"},
    Elsewhere{"plot", "--out", "; the page is --html F"},
    Elsewhere{"hunt", "--rate", "; a hunt varies the rate itself, and --module selects"},
    Elsewhere{"hunt", "--rates", "; a hunt varies the rate itself, and --module selects"},
    Elsewhere{"hunt", "--filter", "; a hunt makes its inputs itself, and --module selects"},
};

// Empty: no command has it, or its name is to be corrected.
std::string_view instead_of(std::string_view command, std::string_view word) {
  for (const Elsewhere& one : elsewhere) {
    if (one.command == command && one.word == word) return one.instead;
  }
  return "";
}

}  // namespace

std::string unknown_command(const CLI::App& app, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), word) != names.end()) return "";
  std::error_code unknown;
  const bool is_file = std::filesystem::is_regular_file(word, unknown);
  return fmt::format(
      "unknown command `{}`{}; attest --help shows them", word,
      is_file ? fmt::format("; did you mean `attest run {}`?", word) : suggestion(word, names));
}

std::string unknown_option(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> names;
  std::string command;  // empty: none is given
  const auto add = [&](const CLI::App& one) {
    for (const CLI::Option* option : one.get_options()) {
      for (const std::string& name : option->get_snames()) names.push_back("-" + name);
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
      for (const std::string& name : option->get_fnames()) names.push_back("--" + name);
    }
  };
  add(app);
  for (const CLI::App* chosen : app.get_subcommands()) {
    add(*chosen);
    command = chosen->get_name();
  }
  for (int i = 1; i < argc; ++i) {
    std::string word = std::string(argv[i]).substr(0, std::string(argv[i]).find('='));
    if (word == "--") break;
    const bool is_short =
        word.size() > 1 && word[0] == '-' && std::isalpha(static_cast<unsigned char>(word[1])) != 0;
    if (!is_short && !word.starts_with("--")) continue;
    if (is_short) word.resize(2);  // the value of -j4
    if (std::find(names.begin(), names.end(), word) != names.end()) continue;
    const std::string_view instead = instead_of(command, word);
    return fmt::format("unknown option `{}`{}; attest {}--help shows them", word,
                       instead.empty() && !is_short ? suggestion(word, names) : instead,
                       command.empty() ? "" : command + " ");
  }
  return "";
}

namespace {

// "WANT and --rate": the required arguments and options that were not given.
std::string missing_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_required() || option->count() > 0) continue;
    names.push_back(option->get_positional() ? option->get_type_name() : option->get_name());
  }
  return fmt::format("{}", fmt::join(names, " and "));
}

// What CLI11 reports, in our words.
std::string reworded(const CLI::App& app, const CLI::ParseError& error) {
  const std::string text = error.what();
  const auto commands = app.get_subcommands();
  const std::string missing = commands.empty() ? "" : missing_of(*commands.front());
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr && !missing.empty()) {
    return fmt::format("attest {} needs {}", commands.front()->get_name(), missing);
  }
  if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr &&
      text == "--port excludes port") {
    const std::string_view instead = instead_of(commands.front()->get_name(), "");
    return fmt::format("the port is given twice, as an argument and with --port{}", instead);
  }
  const std::size_t colon = text.find(": ");
  if (colon == std::string::npos) return text;
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr &&
      text.starts_with("--case: At Most 1 ")) {
    return "the case is given twice, with --case and as the first argument";
  }
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    const std::string words = text.substr(colon + 2);
    const std::string command = commands.empty() ? "" : commands.front()->get_name();
    const std::string_view instead = instead_of(command, words);
    return fmt::format("too many arguments: `{}`{}", words,
                       instead.empty() ? instead_of(command, "") : instead);
  }
  const std::string_view lacks_value = " missing";
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr &&
      text.ends_with(lacks_value)) {
    return fmt::format("{} needs a value", text.substr(0, colon));
  }
  return text;
}

}  // namespace

std::string wrong_usage(const CLI::App& app, const CLI::ParseError& error) {
  const auto commands = app.get_subcommands();
  const bool lacks_command = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  if (commands.empty() && lacks_command) return "name a command; attest --help lists them";
  return fmt::format("{}; attest {}--help describes the options", reworded(app, error),
                     commands.empty() ? "" : commands.front()->get_name() + " ");
}

std::string wrong_value(const CLI::App& app) {
  for (const CLI::App* command : app.get_subcommands()) {
    for (const CLI::Option* option : command->get_options()) {
      // CLI11 adds the range of a number to the name of its type: "X:NONNEGATIVE". Its range check
      // accepts NaN.
      const std::string type = option->get_type_name();
      const bool is_number = type.starts_with("FLOAT") || type.find(':') != std::string::npos;
      for (const std::string& text : option->results()) {
        if (text.empty()) return option->get_name() + ": is empty; is a variable not set?";
        if (is_number && !std::isfinite(std::strtod(text.c_str(), nullptr))) {
          return fmt::format("{}: {} is not a finite number", option->get_name(), text);
        }
      }
    }
  }
  return "";
}

namespace {

namespace fs = std::filesystem;

// The script `check` of `attest new-port`, which calls attest itself.
bool is_check_script(const std::string& file) {
  if (fs::path(file).filename() != "check") return false;
  const auto text = read_file(file);
  return text && text->starts_with("#!") && text->find("attest run --port") != std::string::npos;
}

// How a command line names a case.
struct CaseWords {
  std::string name;   // "attitude/roll"; empty: it is no case
  std::string suite;  // of --suite; empty: it is not needed
};

CaseWords case_meant(const std::string& given, const Globals& globals) {
  const auto suite = find_suite(globals.suite);
  const fs::path file = given;
  if (given.ends_with(".toml") && is_suite_file(file)) {
    const fs::path group = file.parent_path();
    const fs::path root = group.parent_path().parent_path().parent_path();
    std::error_code unknown;
    const bool is_other = !suite || !fs::equivalent(root, suite->root, unknown);
    return {(group.filename() / file.stem()).string(), is_other ? root.string() : globals.suite};
  }
  Selection selection;
  selection.filters = {full_case_name(given)};
  const bool is_case = suite && select_cases(suite->case_folders(), selection);
  return {is_case ? given : "", globals.suite};
}

}  // namespace

std::string wrong_port(const CLI::App& app, const Globals& globals) {
  const CLI::App& command = *app.get_subcommands().front();
  const CLI::Option* option = command.get_option_no_throw("port");
  if (option == nullptr || option->count() == 0) option = command.get_option_no_throw("--port");
  if (option == nullptr || option->count() == 0) return "";
  const std::string given = option->results().back();
  if (const std::string file = argument_of(given); is_check_script(file)) {
    return fmt::format(
        "{0} builds a port and runs attest itself: start it with the options of `attest run`, such "
        "as `{0} --rate 250`, or name the port that it builds",
        file);
  }
  if (!kind_of(given).prefix.empty()) return "";
  const CaseWords words = case_meant(given, globals);
  if (words.name.empty()) return "";
  for (const char* takes : {"--case", "--filter"}) {
    if (command.get_option_no_throw(takes) == nullptr) continue;
    const std::string suite = words.suite.empty() ? "" : " --suite " + shell_word(words.suite);
    const CLI::Option* const first = command.get_option_no_throw("case");
    const bool has_port =
        first != nullptr && first->count() > 0 && is_port(first->results().back());
    return fmt::format("{} is a case, not a port; write: attest{} {} {} {}{}", given, suite,
                       command.get_name(), takes, shell_word(words.name),
                       has_port ? " --port " + shell_word(first->results().back()) : "");
  }
  return given + " is a case, not a port";
}

}  // namespace attest::cli
