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
constexpr std::array fixed_types{"FORMAT", "KIND", "LANG", "LEVEL", "MODULE", "PLANT", "POLICY"};

// Types of options whose values the function _attest_values of the script prints.
constexpr std::array listed_types{"CASE", "GLOB", "GROUP",   "HZ",     "HZ,...",
                                  "ID",   "PORT", "PROFILE", "VEHICLE"};

// What may come next in a command line.
struct Word {
  std::string text, description;  // the latter may be empty
};

// These functions run in bash and in zsh. They print lines of a word, or of a word, a tab and its
// description.
constexpr std::string_view functions = R"(# Completion for attest.

# Prints the first column and the last column of a list. Two spaces or more are between columns.
_attest_listed() {
  local line
  attest "$@" 2>/dev/null |
    while IFS= read -r line; do printf '%s\t%s\n' "${line%%  *}" "${line##*  }"; done
}

# Prints the folders that begin with $2, and the files that a port of the kind $1 can be.
_attest_files() {
  local file
  for file in "$2"*; do
    if [[ -d $file ]]; then
      printf '%s%s/\n' "$1" "$file"
    elif [[ $1 == lib: && $file == *.so && -e $file || $1 == proc: && -x $file ]]; then
      printf '%s%s\n' "$1" "$file"
    fi
  done
}

# Prints the values of the type $1, of which $2 is typed.
_attest_values() {
  local id about
  case $1 in
    CASE | GLOB)
      _attest_listed list | while IFS=$'\t' read -r id about; do
        printf '%s\t%s\n%s\t%s\n' "$id" "$about" "${id##*/}" "$about"
      done ;;
    GROUP) _attest_listed list --groups | while read -r id about; do echo "${id##*/}"; done ;;
    ID) _attest_listed faults --list ;;
    PROFILE) _attest_listed list --groups | while read -r id about; do echo "${id%%/*}"; done ;;
    VEHICLE)
      _attest_listed list --vehicles |
        while read -r id about; do [ "$id" = vehicle ] || echo "$id"; done ;;
    HZ*)
      printf '%s\n' 50 100 250 333 400 500 800 1000 2000 4000 8000 ;;
    PORT)
      id=${2#*:}
      case $2 in
        fault:*)
          _attest_listed faults --list |
            while IFS= read -r id; do printf 'fault:%s\n' "$id"; done ;;
        lib:* | proc:* | recorded:*) _attest_files "${2%%:*}:" "${id//\\/}" ;;
        *)
          printf '%s\n' $'builtin\tthe reference of attest' $'lib:\ta shared library' \
            $'proc:\ta program' $'fault:\tthe reference with one mistake' \
            $'recorded:\tfiles with the outputs of a port' ;;
      esac ;;
  esac
}

)";

template <std::size_t N>
bool is_one_of(const std::string& type, const std::array<const char*, N>& types) {
  return std::find(types.begin(), types.end(), type) != types.end();
}

// The help up to its first stop, which fits into a line.
std::string first_clause(const std::string& help) {
  return help.substr(0, std::min({help.find(". "), help.find(": "), help.find(';')}));
}

std::vector<Word> command_words(const CLI::App& app) {
  std::vector<Word> words;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    words.push_back({command->get_name(), first_clause(command->get_description())});
  }
  return words;
}

// The words of the help between backquotes, each with the text in parentheses that may follow it.
// Words with a space or a colon are left out, because they have a placeholder: `lib:PATH`.
std::vector<Word> words_in_backquotes(const std::string& help) {
  std::vector<Word> words;
  for (std::size_t at = help.find('`'); at != std::string::npos;) {
    const std::size_t end = help.find('`', at + 1);
    if (end == std::string::npos) break;
    const std::string word = help.substr(at + 1, end - at - 1);
    const bool is_known = std::any_of(words.begin(), words.end(),
                                      [&](const Word& known) { return known.text == word; });
    if (word.find_first_of(" :") == std::string::npos && !is_known) {
      const std::size_t close = help.compare(end + 1, 2, " (") == 0 ? help.find(')', end) : 0;
      words.push_back({word, close == 0 ? "" : help.substr(end + 3, close - end - 3)});
    }
    at = help.find('`', end + 1);
  }
  return words;
}

// The command that prints the words, one in each line.
std::string print(const std::vector<Word>& words) {
  std::string text;
  const auto add = [&](const std::string& part) {
    for (const char c : part) {
      if (c == '\'' || c == '\\') text += '\\';
      text += c == '\n' ? ' ' : c;
    }
  };
  for (const Word& word : words) {
    if (!text.empty()) text += "\\n";
    add(word.text);
    if (!word.description.empty()) text += "\\t";
    add(word.description);
  }
  return fmt::format("printf '%s\\n' $'{}'", text);
}

// The command that prints the values of an option. Empty: they are names of files, or of things
// that attest does not know.
std::string print_values_of(const CLI::App& app, const CLI::Option& option) {
  const std::string type = value_name(option);
  if (type == "COMMAND") return print(command_words(app));
  if (is_one_of(type, listed_types)) return fmt::format("_attest_values {} \"$3\"", type);
  if (!is_one_of(type, fixed_types)) return "";
  return print(words_in_backquotes(option.get_description()));
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  return names;
}

// The lines of `case` for the options of a command that have a value.
std::string value_lines(const CLI::App& app, const CLI::App& command) {
  std::string lines;
  for (const CLI::Option* option : command.get_options()) {
    if (!option->nonpositional() || option->get_items_expected_max() == 0) continue;
    std::vector<std::string> patterns;
    for (const std::string& each : names_of(*option)) {
      patterns.push_back(fmt::format("\"{} {}\"", command.get_name(), each));
    }
    lines +=
        fmt::format("    {}) {} ;;\n", fmt::join(patterns, " | "), print_values_of(app, *option));
  }
  return lines;
}

// What may come elsewhere in the command line: an option, or the value of the first positional
// argument.
std::string other_lines(const CLI::App& app, const CLI::App& command) {
  std::vector<Word> options;
  std::string values;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;  // hidden
    if (option->get_positional() && values.empty()) values = print_values_of(app, *option);
    for (const std::string& each : names_of(*option)) {
      options.push_back({each, first_clause(option->get_description())});
    }
  }
  if (values.empty()) values = ":";
  return fmt::format("    \"{0} \"*) if [[ $3 == -* ]]; then {1}; else {2}; fi ;;\n",
                     command.get_name(), print(options), values);
}

// The function _attest_words, which prints what may come in a command line: $1 is the command of
// attest, $2 the word before, $3 what is typed.
std::string words_function(const CLI::App& app) {
  std::vector<Word> first_words = command_words(app);
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& each : names_of(*option)) {
      first_words.push_back({each, first_clause(option->get_description())});
    }
  }
  std::string lines;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    lines += value_lines(app, *command) + other_lines(app, *command);
  }
  return fmt::format(R"(_attest_words() {{
  case "$1 $2" in
{}    *" --suite" | *" --port-reads") ;;
    *) {} ;;
  esac
}}

)",
                     lines, print(first_words));
}

// The pattern of `case` that matches a command.
std::string any_command(const CLI::App& app) {
  std::vector<std::string> names;
  for (const Word& command : command_words(app)) names.push_back(command.text);
  return fmt::format("{}", fmt::join(names, " | "));
}

// {0} is the pattern of a command.
constexpr const char* bash_function = R"(_attest() {{
  local cur prev command='' words=() word quoted before=''
  # Bash splits words at colons, for example lib:./port.so.
  for word in "${{COMP_WORDS[@]:0:COMP_CWORD+1}}"; do
    if ((${{#words[@]}} > 1)) && [[ $word == : || ${{words[-1]}} == *: ]]; then
      words[-1]+=$word
    else
      words+=("$word")
    fi
  done
  cur=${{words[-1]}} prev=${{words[-2]}}
  unset 'words[-1]'
  for word in "${{words[@]:1}}"; do
    case $word in
      {0}) command=$word; break ;;
    esac
  done
  [[ ${{COMP_WORDBREAKS-}} != *:* ]] || before=${{cur%"${{cur##*:}}"}}
  COMPREPLY=()
  # Names are files' names, so they are never expanded, and are quoted for the command line.
  while IFS=$'\t' read -r word quoted; do
    [[ -n $word ]] || continue
    printf -v quoted %q "$word"
    [[ $word == "$cur"* || $quoted == "$cur"* ]] && COMPREPLY+=("${{quoted#"$before"}}")
  done < <(_attest_words "$command" "$prev" "$cur")
  # More text follows a kind of port or a folder.
  [[ ${{COMPREPLY[0]-}} != *[:/] ]] || compopt -o nospace 2>/dev/null
}}
complete -o default -F _attest attest
)";

// zsh loads the file at the first completion. The last lines answer this completion, too.
constexpr const char* zsh_function = R"(_attest() {{
  local command='' word about i found=1
  local -a whole begun
  for ((i = 2; i < CURRENT; ++i)); do
    case ${{words[i]}} in
      {0}) command=${{words[i]}}; break ;;
    esac
  done
  while IFS=$'\t' read -r word about; do
    [[ -n $word ]] || continue
    about=${{word//:/\\:}}${{about:+:$about}}
    # More text follows a kind of port or a folder.
    if [[ $word == *[:/] ]]; then begun+=("$about"); else whole+=("$about"); fi
  done < <(_attest_words "$command" "${{words[CURRENT-1]}}" "$PREFIX")
  _describe attest whole && found=0
  _describe attest begun -S '' && found=0
  ((found == 0)) || _files
}}
if [[ ${{funcstack[1]-}} == _attest ]]; then _attest "$@"; else compdef _attest attest; fi
)";

}  // namespace

std::string value_name(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.substr(0, std::min(type.find(':'), type.size()));
}

std::string bash_completion(const CLI::App& app) {
  return std::string(functions) + words_function(app) +
         fmt::format(fmt::runtime(bash_function), any_command(app));
}

std::string zsh_completion(const CLI::App& app) {
  return "#compdef attest\n" + std::string(functions) + words_function(app) +
         fmt::format(fmt::runtime(zsh_function), any_command(app));
}

}  // namespace attest::cli
