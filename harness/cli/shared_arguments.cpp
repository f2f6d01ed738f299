#include "harness/cli/shared_arguments.hpp"

#include <algorithm>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/core/suggestion.hpp"
#include "harness/golden/recorded.hpp"
#include "harness/port/port.hpp"
#include "harness/port/profiles.hpp"
#include "harness/report/report.hpp"
#include "harness/ulog/flight_log.hpp"

namespace attest::cli {
namespace {

// The default assumptions for the attitude unit and the rate unit together.
std::string assumed_by_default_of_units() {
  std::vector<std::string> words = assumption_words(Module::attitude_unit, true);
  for (const std::string& word : assumption_words(Module::rate_unit, true)) {
    if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
  }
  return fmt::format("{}", fmt::join(words, ","));
}

}  // namespace

bool is_port(const std::string& given) {
  return !given.ends_with(".toml") && !kind_of(port_of_file(given)).prefix.empty();
}

void add_port_argument(Command command, HostOptions& host) {
  command.option("port", host.port, "The same as --port")
      .type("PORT")
      .rewritten(port_of_file)
      .excludes(command.find("--port"));
}

void add_port(Command command, HostOptions& host, Ports accepted) {
  host.barrier = command.globals().barrier;
  const std::string kinds = names_of_port_kinds(accepted == Ports::callable);
  const Option option =
      command
          .option("--port", host.port,
                  fmt::format("Port to run: {}, or the file of a library or program; `builtin` "
                              "is the reference of attest",
                              kinds))
          .type("PORT")
          .shows_default()
          .rewritten(port_of_file);
  if (accepted == Ports::any) return;
  option.check([](const std::string& given) -> std::string {
    if (kind_of(given).is_callable()) return "";
    return fmt::format(
        "{}: this command must call the port, and the outputs of a recorded port are files; use "
        "`attest run`",
        given);
  });
}

void add_timeout(Command command, double& timeout_s) {
  command
      .option(
          "--timeout", timeout_s,
          "Limit for each answer of the port [s]: a library answers with 2,048 ticks of a trace "
          "or a whole flight, in stress with a step; a program with a step or a batch of steps. "
          "Counts the CPU time of the port's processes; they may sleep three times as long")
      .range(0.1, 86400.0)
      .shows_default()
      .group(option_group::execution);
}

void add_page(Command command, std::string& file, const char* what) {
  command.option("--html", file, fmt::format("Write {}", what))
      .type("F.html")
      .group(option_group::reports);
}

void add_json_and_junit(Command command, std::string& json, const char* what, std::string& junit) {
  command.option("--json", json, what).type("F").group(option_group::reports);
  command.option("--junit", junit, "Write a JUnit XML report")
      .type("F")
      .group(option_group::reports);
}

Option add_jobs(Command command, int& jobs, const char* what, const char* usual) {
  jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return command.option("--jobs,-j", jobs, fmt::format("{}; default: {}", what, usual))
      .type("N")
      .range(1, 1024)
      .group(option_group::execution);
}

Option add_rates(Command command, std::vector<std::string>& rates, const char* what) {
  return command.option("--rate,--rates", rates, what)
      .type("HZ,...")
      .separated_by_commas()
      .one_each_time();
}

Option add_case(Command command, CaseChoice& choice, const char* name, const char* what) {
  const Option added =
      command.option(name, choice.name, what).type("CASE").rewritten(full_case_name);
  command
      .option(
          "--profile", choice.profile,
          "Version of the law; default: the newest of the port that has the case; of the reference "
          "v1.5.5, or v1.18 for a pair of rates or a case that v1.5.5 lacks")
      .type("PROFILE")
      .rewritten(full_profile_name);
  return choice.name.empty() ? added : added.shows_default();
}

Option add_parameters(Command command, std::vector<std::string>& parameters, const char* what) {
  return command.option("--param", parameters, what)
      .type("NAME=VALUE")
      .one_each_time()
      .check([](const std::string& text) {
        const auto change = parse_parameter(text);
        return change ? "" : text + ": " + change.error().message;
      });
}

void add_plant(Command command, std::string& vehicle, std::string& plant, const char* usual_vehicle,
               const char* usual_plant) {
  command
      .option("--vehicle", vehicle,
              fmt::format("Vehicle, one of `attest list --vehicles`; default: {}", usual_vehicle))
      .type("VEHICLE");
  command
      .option("--plant", plant, fmt::format("Plant: `mujoco` or `ode`; default: {}", usual_plant))
      .type("PLANT");
}

void add_selection(Command command, SelectionOptions& options, Selects selects) {
  const auto add = [&](const char* name, std::vector<std::string>& values, const char* what,
                       const char* type) {
    return command.option(name, values, what)
        .type(type)
        .one_each_time()
        .group(option_group::selection);
  };
  const bool with_flights = selects == Selects::all_vectors;
  add("--filter", options.filters,
      with_flights ? "Only vectors whose id matches this shell pattern: "
                     "PROFILE/GROUP/NAME@RATEhz, for a flight "
                     "PROFILE/GROUP/NAME@RATEhz-VEHICLE-PLANT; PROFILE/ and the part from @ on "
                     "are optional"
                   : "Only vectors whose id matches this shell pattern: "
                     "PROFILE/GROUP/NAME@RATEhz; PROFILE/ and @RATEhz are optional",
      "GLOB")
      .rewritten(full_case_name);
  add("--exclude", options.excludes, "Leave out the vectors whose id matches this shell pattern",
      "GLOB")
      .rewritten(full_case_name);
  add("--group", options.groups, "Only these groups of cases, separated by commas", "GROUP")
      .separated_by_commas();
  add("--profile", options.profiles, "Only these versions of the law, separated by commas",
      "PROFILE")
      .separated_by_commas()
      .rewritten(full_profile_name);
  add_rates(command, options.rates,
            with_flights ? "Only these loop rates [Hz], separated by commas; flights of v1.14 to "
                           "v1.18 have pairs such as 250:1000, and one rate selects all pairs in "
                           "which the rate unit has it: 250 also selects 50:250"
                         : "Only these loop rates [Hz], separated by commas")
      .group(option_group::selection);
  command
      .flag("--core", options.core,
            "Only the core of the suite: few vectors that catch the same faults of the catalogue, "
            "for a slow port")
      .group(option_group::selection);
  if (!with_flights) return;
  command
      .flag("--core-flights", options.core_flights,
            "Only the flights of the core: few that catch what flights catch")
      .group(option_group::selection);
  add("--vehicle", options.vehicles, "Only flights of these vehicles, separated by commas",
      "VEHICLE")
      .separated_by_commas();
  add("--plant", options.plants, "Only flights on this plant: `mujoco` or `ode`", "PLANT")
      .separated_by_commas();
}

std::string full_profile_name(const std::string& given) {
  const std::string full = given.starts_with("px4-") ? given : "px4-" + given;
  if (find_profile(full) != nullptr) return full;
  std::vector<std::string> begun = known_profile_names();
  std::erase_if(begun, [&](const std::string& name) { return !name.starts_with(full + "."); });
  return begun.size() == 1 ? begun.front() : given;
}

std::string full_case_name(const std::string& given) {
  const std::size_t slash = std::min(given.find('/'), given.size());
  return full_profile_name(given.substr(0, slash)) + given.substr(slash);
}

Result<void> check_profiles(const std::vector<std::string>& names) {
  const std::vector<std::string> known = known_profile_names();
  for (const std::string& name : names) {
    if (find_profile(name) != nullptr) continue;
    return fail(fmt::format("no profile `{}`{}; there are {}", name, suggestion(name, known),
                            fmt::join(known, ", ")));
  }
  return {};
}

void add_assumed(Command command, std::vector<std::string>& assumed) {
  command
      .option("--assume", assumed,
              fmt::format(
                  "What was true in the flight where the log lacks a topic: some of {}; default "
                  "for v1.5.5 and v1.3.4: {}; default for v1.14 to v1.18: {}",
                  fmt::join(assumption_words(), ", "),
                  fmt::join(assumption_words(Module::mc_att_control, true), ","),
                  assumed_by_default_of_units()))
      .type("WORD,...")
      .separated_by_commas()
      .one_each_time()
      .group(option_group::logs);
}

void add_reports(Command command, ReportOptions& options) {
  command
      .flag("--diagnose,!--no-diagnose", options.diagnose,
            "After a failure, name the probable mistake; default: on")
      .group(option_group::reports);
  command
      .flag("-v,--verbose", options.verbose,
            "Show every failing case, tables by rate, and the accuracy of each signal; default: a "
            "case of each kind of failure")
      .group(option_group::reports);
  for (const ReportFormat& format : report_formats()) {
    command.option(format.option.c_str(), options.files[format.option], format.help)
        .type("FILE")
        .group(option_group::reports);
  }
  command
      .flag("--github", options.github,
            "Print annotations for GitHub Actions, and add to the job summary")
      .group(option_group::reports);
}

Result<std::vector<ParameterChange>> parse_parameters(const std::vector<std::string>& texts,
                                                      const std::vector<SelectedCase>& cases) {
  std::vector<ParameterChange> parameters;
  for (const std::string& text : texts) {
    const auto change = parse_parameter(text);
    Result<void> accepted;
    if (!change) accepted = tl::unexpected(change.error());
    for (const SelectedCase& selected : cases) {
      if (!change) break;
      accepted = check_parameter(subject_of(selected.the_case), *change);
      if (accepted) break;
    }
    if (!accepted) return fail(fmt::format("--param {}: {}", text, accepted.error().message));
    parameters.push_back(*change);
  }
  std::ranges::stable_sort(parameters, {}, &ParameterChange::name);
  return parameters;
}

}  // namespace attest::cli
