#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fnmatch.h>

#include "harness/cli/outputs.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/core/file.hpp"
#include "harness/core/suggestion.hpp"
#include "harness/host/file_format.hpp"
#include "harness/report/signals_document.hpp"
#include "harness/trace/channels.hpp"

namespace attest::cli {
namespace {

struct PlotOptions {
  std::vector<std::string> files;
  std::vector<std::string> signals;  // shell patterns; empty: the outputs, or all if there are none
  std::string html;  // empty: the name of the first file, with .html, in the working folder
  bool list = false;
};

constexpr std::size_t most_signals = 100;

Result<std::vector<TimedSignals>> sources_of(const std::vector<std::string>& files) {
  std::vector<TimedSignals> sources;
  for (const std::string& file : files) {
    auto signals = read_as<&FileFormat::read_signals>(file);
    if (!signals) return tl::unexpected(signals.error());
    for (const std::string& note : signals->notes) {
      fmt::print(stderr, "attest: note: {}: {}\n", file, note);
    }
    sources.push_back(*std::move(signals));
  }
  return sources;
}

std::vector<std::string> names_in(const std::vector<TimedSignals>& sources) {
  std::set<std::string> names;
  for (const TimedSignals& source : sources) {
    for (const TimedSignal& signal : source.all) names.insert(signal.name);
  }
  return {names.begin(), names.end()};
}

// True if `name` is a float output of the controller or, if `is_of_controller` is false, of the
// attitude unit or the rate unit.
bool is_output(const std::string& name, bool is_of_controller) {
  const auto all = modules();
  return std::any_of(all.begin(), all.end(), [&](const ModuleInfo& info) {
    const bool is_controller = info.module == Module::mc_att_control;
    const auto channel = find_channel(info.module, "out/" + name);
    return info.is_unit() && is_controller == is_of_controller && channel &&
           channels()[*channel].type == ChannelType::f32;
  });
}

// The outputs of the controller or of the units of v1.14 to v1.18; all signals if there is no
// output.
std::vector<std::string> names_by_default(const std::vector<std::string>& all) {
  const bool is_of_controller = std::any_of(all.begin(), all.end(), [](const std::string& name) {
    return name.starts_with("actuator_controls_0.") || name.starts_with("control_state.");
  });
  std::vector<std::string> outputs;
  std::copy_if(all.begin(), all.end(), std::back_inserter(outputs),
               [&](const std::string& name) { return is_output(name, is_of_controller); });
  return outputs.empty() ? all : outputs;
}

// Errors: a pattern without a match.
Result<std::vector<std::string>> chosen(const std::vector<std::string>& all,
                                        const std::vector<std::string>& patterns) {
  if (patterns.empty()) return names_by_default(all);
  std::set<std::string> names;
  for (const std::string& pattern : patterns) {
    const std::size_t before = names.size();
    for (const std::string& name : all) {
      // `==` is needed because the brackets of a name have a meaning in a pattern.
      if (name == pattern || ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0) names.insert(name);
    }
    if (names.size() == before) {
      return fail(fmt::format("--channels: no signal matches `{}`{}; --list shows all", pattern,
                              suggestion(pattern, all)));
    }
  }
  return std::vector<std::string>(names.begin(), names.end());
}

int plot_command(const PlotOptions& options, const Globals& globals) {
  const std::string first = std::filesystem::path(options.files.front()).stem().string();
  const std::string page = options.html.empty() ? first + ".html" : options.html;
  if (!options.list) {
    const auto checked = check_outputs({page}, {"", options.files}, globals.suite);
    if (!checked) return report_error(checked.error());
  }
  const auto sources = sources_of(options.files);
  if (!sources) return report_error(sources.error());
  const std::vector<std::string> all = names_in(*sources);
  if (options.list) {
    for (const std::string& name : all) fmt::print("{}\n", name);
    return exit_ok;
  }
  auto names = chosen(all, options.signals);
  if (!names) return report_error(names.error());
  if (names->size() > most_signals) {
    if (!options.signals.empty()) {
      return report_error(
          {fmt::format("--channels: {} signals match, and a page has at most {}; "
                       "choose fewer",
                       names->size(), most_signals)});
    }
    names->resize(most_signals);
  }
  if (auto written = write_file(page, html_page(signals_document(*sources, *names))); !written) {
    return report_error(written.error());
  }
  if (!globals.quiet && page != "-") {
    fmt::print("{}: {} of {} signals\n", page, names->size(), all.size());
  }
  return exit_ok;
}

}  // namespace

void add_plot(const CommandLine& line) {
  auto options = std::make_shared<PlotOptions>();
  const Command command = line.add("plot", "Plot signals of traces and flight logs on one page");
  command
      .option("files", options->files,
              "CSV files with a column `timestamp` [us], or flight logs (.ulg)")
      .type("TRACE")
      .required();
  command
      .option("--channels", options->signals,
              "Only signals whose name matches one of these shell patterns; default: the "
              "controller's outputs, else all, up to 100")
      .type("GLOB,...")
      .separated_by_commas()
      .one_each_time();
  command.flag("--list", options->list, "List the signals, and write no page");
  command
      .option("--html", options->html,
              "Write this page; default: that of the first file, with .html as its ending, in the "
              "current folder")
      .type("F.html")
      .group(option_group::reports);
  command.examples({{"attest plot flown.csv flight.ulg --channels 'control_state.*_rate'",
                     "plot the body rates of two flights"},
                    {"attest plot flight.ulg --list", "list the signals of a log"}});
  command.runs(options, plot_command);
}

}  // namespace attest::cli
