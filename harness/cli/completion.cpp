#include "harness/cli/completion.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace attest::cli {
namespace {

// Types of options whose values are the words in backquotes in their help.
constexpr std::array fixed_types{"FORMAT", "KIND",  "LANG",   "LEVEL",
                                 "MODULE", "PLANT", "POLICY", "PORT"};

// Types of options whose values the function _attest_values of the script prints.
constexpr std::array listed_types{"CASE", "GROUP", "HZ", "HZ,...", "PROFILE", "VEHICLE"};

constexpr std::string_view functions = R"(# Completion for attest.

# The first column of what attest lists; two spaces are between the columns.
_attest_listed() {
  local line
  attest list "$@" 2>/dev/null |
    while IFS= read -r line; do printf '%s\n' "${line%%  *}"; done
}

_attest_values() {
  local id
  case $1 in
    CASE) _attest_listed | while IFS= read -r id; do printf '%s\n' "$id" "${id##*/}"; done ;;
    GROUP) _attest_listed --groups | while IFS= read -r id; do printf '%s\n' "${id##*/}"; done ;;
    PROFILE) _attest_listed --groups | while IFS= read -r id; do printf '%s\n' "${id%%/*}"; done ;;
    VEHICLE)
      _attest_listed --vehicles |
        while IFS= read -r id; do [ "$id" = vehicle ] || printf '%s\n' "$id"; done ;;
    HZ*)
      printf '%s\n' 50 100 250 333 400 500 800 1000 2000 4000 8000 ;;
  esac
}

)";

template <std::size_t N>
bool is_one_of(const std::string& type, const std::array<const char*, N>& types) {
  return std::find(types.begin(), types.end(), type) != types.end();
}

// The words of the help between backquotes. Words with a space or a colon are left out, because
// they have a placeholder: `lib:PATH`.
std::vector<std::string> words_in_backquotes(const std::string& help) {
  std::vector<std::string> words;
  for (std::size_t at = help.find('`'); at != std::string::npos;) {
    const std::size_t end = help.find('`', at + 1);
    if (end == std::string::npos) break;
    const std::string word = help.substr(at + 1, end - at - 1);
    const bool is_plain = word.find_first_of(" :") == std::string::npos;
    if (is_plain && std::find(words.begin(), words.end(), word) == words.end()) {
      words.push_back(word);
    }
    at = help.find('`', end + 1);
  }
  return words;
}

// Words as one quoted text of the script, one word in each line. They are names from the command
// line, so no character in them must be escaped.
std::string quoted_lines(const std::vector<std::string>& words) {
  return fmt::format("$'{}'", fmt::join(words, "\\n"));
}

// The right-hand side of an assignment in the script: what completes a value of the option.
std::string values_of(const CLI::Option& option) {
  const std::string type = value_name(option);
  if (is_one_of(type, listed_types)) return fmt::format("$(_attest_values {})", type);
  if (!is_one_of(type, fixed_types)) return "";
  return quoted_lines(words_in_backquotes(option.get_description()));
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  return names;
}

// The lines of `case` for the options of a command that have a value.
std::string value_lines(const CLI::App& command, const std::string& name) {
  std::string lines;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional() || option->get_items_expected_max() == 0) continue;
    std::vector<std::string> patterns;
    for (const std::string& each : names_of(*option)) {
      patterns.push_back(fmt::format("\"{} {}\"", name, each));
    }
    lines += fmt::format("    {}) words={} ;;\n", fmt::join(patterns, " | "), values_of(*option));
  }
  return lines;
}

// What may come elsewhere in the command line: an option, or the value of the first positional
// argument.
std::string other_line(const CLI::App& command, const std::string& name) {
  std::vector<std::string> options;
  std::string values;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;  // hidden
    if (option->get_positional() && values.empty()) values = values_of(*option);
    for (const std::string& each : names_of(*option)) options.push_back(each);
  }
  return fmt::format("    \"{} \"*) words={}; [[ $cur == -* ]] || words={} ;;\n", name,
                     quoted_lines(options), values);
}

std::string script_body(const CLI::App& app) {
  std::vector<std::string> commands, first_words;
  std::string lines;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    const std::string& name = command->get_name();
    commands.push_back(name);
    lines += value_lines(*command, name) + other_line(*command, name);
  }
  first_words = commands;
  first_words.insert(first_words.end(), {"--suite", "--quiet", "--version", "--help"});
  return std::string(functions) + fmt::format(R"(_attest() {{
  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD-1]}} command= words= i
  local word quoted
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case ${{COMP_WORDS[i]}} in
      {0}) command=${{COMP_WORDS[i]}}; break ;;
    esac
  done
  case "$command $prev" in
{1}    *" --suite") ;;
    *) words={2} ;;
  esac
  COMPREPLY=()
  # Names are files' names, so they are never expanded, and are quoted for the command line.
  while IFS= read -r word; do
    [[ -n $word ]] || continue
    printf -v quoted %q "$word"
    [[ $word == "$cur"* || $quoted == "$cur"* ]] && COMPREPLY+=("$quoted")
  done <<<"$words"
}}
)",
                                              fmt::join(commands, " | "), lines,
                                              quoted_lines(first_words));
}

constexpr const char* registration = "complete -o default -F _attest attest\n";

}  // namespace

std::string value_name(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.substr(0, std::min(type.find(':'), type.size()));
}

std::string bash_completion(const CLI::App& app) { return script_body(app) + registration; }

std::string zsh_completion(const CLI::App& app) {
  // zsh loads the file at the first completion. The last line answers this completion, too.
  return "#compdef attest\nautoload -U +X bashcompinit && bashcompinit\n" + script_body(app) +
         registration +
         "[[ ${funcstack[1]-} != _attest ]] || _bash_complete -o default -F _attest\n";
}

}  // namespace attest::cli
