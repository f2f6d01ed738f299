#include "harness/cli/man_page.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/cli/completion.hpp"
#include "harness/core/file.hpp"
#include "harness/core/version.hpp"

namespace attest::cli {
namespace {

// Text between backquotes becomes bold. `-` is a minus, as in an option, and not a hyphen.
std::string roff(std::string_view text) {
  std::string out;
  bool is_bold = false;
  for (const char c : text) {
    if (c == '`')
      out += std::exchange(is_bold, !is_bold) ? "\\fR" : "\\fB";
    else if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else if (c == '\n')
      out += ' ';
    else
      out += c;
  }
  // A line that begins with `.` or `'` would be a request of roff.
  if (out.starts_with('.') || out.starts_with('\'')) out.insert(0, "\\&");
  return out;
}

std::string trimmed(std::string text) {
  text.erase(text.find_last_not_of(" \n.") + 1);
  return text;
}

std::string header(const std::string& title) {
  std::string upper = title;
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return fmt::format(".TH {} 1 \"\" \"attest {}\" \"User Commands\"\n", roff(upper), version);
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<const CLI::Option*> positionals_of(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

// ".TP", the names in bold with the type of the value, and what the option does.
std::string option_text(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  if (names.empty()) names.push_back(value_name(option));
  const bool has_value = option.get_items_expected_max() > 0 && option.nonpositional();
  std::string text = fmt::format(
      ".TP\n\\fB{}\\fR{}\n{}\n", roff(fmt::format("{}", fmt::join(names, ", "))),
      has_value ? " \\fI" + roff(value_name(option)) + "\\fR" : "", roff(option.get_description()));
  const std::string& value = option.get_default_str();
  if (!value.empty()) text += fmt::format(".br\nDefault: {}\n", roff(value));
  return text;
}

std::string options_text(const CLI::App& command) {
  std::string text = ".SH OPTIONS\n";
  for (const CLI::Option* option : positionals_of(command)) {
    if (!option->nonpositional()) text += option_text(*option);
  }
  for (const std::string& group : command.get_groups()) {
    const auto options = command.get_options([&](const CLI::Option* option) {
      return option->get_group() == group && option->nonpositional();
    });
    if (group.empty() || options.empty()) continue;
    if (group != "Options") text += fmt::format(".SS {}\n", roff(group));
    for (const CLI::Option* option : options) text += option_text(*option);
  }
  return text;
}

// Reads the footer that add_examples() makes: a command line indented by 2, and its purpose
// indented by more.
std::string examples_text(const CLI::App& command) {
  std::istringstream examples(command.get_footer());
  std::string text = ".SH EXAMPLES\n";
  for (std::string line; std::getline(examples, line);) {
    const std::size_t indent = line.find_first_not_of(' ');
    if (indent == std::string::npos || indent == 0) continue;
    const std::string content = roff(line.substr(indent));
    text += indent == 2 ? fmt::format(".TP\n\\fB{}\\fR\n", content) : content + "\n";
  }
  return text;
}

constexpr const char* exit_status =
    ".SH EXIT STATUS\n"
    ".TP\n0\nNo failure.\n"
    ".TP\n1\nA failure, or the answer to \\fBattest bless\\fR was no.\n"
    ".TP\n2\nWrong usage or environment: a file, the port, a golden; or no result.\n"
    ".TP\n130\nInterrupted by Ctrl\\-C.\n";

// All variables that attest reads; tests/cli/help.bats compares them with the calls of getenv().
constexpr const char* environment =
    ".SH ENVIRONMENT\n"
    ".TP\n\\fBATTEST_SUITE\\fR\n"
    "Folder with cases/, golden/ and models/, or a zip archive of it, if \\fB\\-\\-suite\\fR is "
    "not given.\n"
    ".TP\n\\fBGITHUB_STEP_SUMMARY\\fR\n"
    "File to which \\fB\\-\\-github\\fR adds the job summary. GitHub Actions sets it.\n"
    ".TP\n\\fBHOME\\fR, \\fBXDG_STATE_HOME\\fR\n"
    "The last report with failures, for \\fB\\-\\-last\\-failed\\fR, is in $XDG_STATE_HOME/attest, "
    "by "
    "default in ~/.local/state/attest.\n"
    ".TP\n\\fBNO_COLOR\\fR\nIf it is not empty, a terminal shows no colours.\n"
    ".TP\n\\fBPATH\\fR\nFolders of the programs that attest starts, such as valgrind.\n"
    ".TP\n\\fBSOURCE_DATE_EPOCH\\fR\n"
    "The date of reports in seconds since 1970, so that equal runs have equal reports.\n"
    ".TP\n\\fBTERM\\fR\nIf it is unset or \\fBdumb\\fR, a terminal shows no colours and no "
    "progress.\n"
    ".TP\n\\fBTMPDIR\\fR\nFolder for temporary files, in place of /tmp.\n";

std::string see_also(const std::vector<std::string>& pages) {
  std::vector<std::string> shown;
  for (const std::string& page : pages) shown.push_back(fmt::format("\\fB{}\\fR(1)", roff(page)));
  return fmt::format(".SH SEE ALSO\n{}\n", fmt::join(shown, ",\n"));
}

std::string page_name(const CLI::App& command) { return "attest-" + command.get_name(); }

std::string synopsis_of(const CLI::App& command) {
  std::string text =
      fmt::format(".SH SYNOPSIS\n\\fBattest {}\\fR [\\fIOPTIONS\\fR]", roff(command.get_name()));
  for (const CLI::Option* option : positionals_of(command)) {
    const bool is_list = option->get_items_expected_max() > 1;
    const std::string name = roff(value_name(*option)) + (is_list ? " ..." : "");
    text += option->get_required() ? fmt::format(" \\fI{}\\fR", name)
                                   : fmt::format(" [\\fI{}\\fR]", name);
  }
  return text + "\n";
}

}  // namespace

std::string man_page_of(const CLI::App& command) {
  const std::string name = page_name(command);
  const std::string what = command.get_description();
  std::string text = header(name);
  text += fmt::format(".SH NAME\n{} \\- {}\n", roff(name), roff(trimmed(what)));
  text += synopsis_of(command);
  text += fmt::format(".SH DESCRIPTION\n{}.\n", roff(trimmed(what)));
  text += options_text(command) + examples_text(command) + exit_status;
  return text + see_also({"attest"});
}

std::string man_page(const CLI::App& app) {
  std::string text = header("attest");
  text +=
      ".SH NAME\nattest \\- conformance suite for ports of PX4 multicopter attitude and rate "
      "control\n"
      ".SH SYNOPSIS\n\\fBattest\\fR [\\fIOPTIONS\\fR] \\fICOMMAND\\fR ...\n";
  text += fmt::format(".SH DESCRIPTION\n{}.\n", roff(trimmed(app.get_description())));
  text += ".SH COMMANDS\n";
  std::vector<std::string> pages;
  for (const CLI::App* command : commands_of(app)) {
    text += fmt::format(".TP\n\\fB{}\\fR\n{}.\n", roff(command->get_name()),
                        roff(trimmed(command->get_description())));
    pages.push_back(page_name(*command));
  }
  return text + options_text(app) + examples_text(app) + exit_status + environment +
         see_also(pages);
}

Result<void> write_man_pages(const CLI::App& app, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return fail_at(folder.string(), error.message());
  if (auto written = write_file(folder / "attest.1", man_page(app)); !written) return written;
  for (const CLI::App* command : commands_of(app)) {
    const auto file = folder / (page_name(*command) + ".1");
    if (auto written = write_file(file, man_page_of(*command)); !written) return written;
  }
  return {};
}

}  // namespace attest::cli
