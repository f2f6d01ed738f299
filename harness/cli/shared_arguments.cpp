#include "harness/cli/shared_arguments.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <thread>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/port/port.hpp"
#include "harness/ulog/flight_log.hpp"

namespace attest::cli {
namespace {

class PlainFlagNames final : public CLI::Formatter {
 public:
  std::string make_option_name(const CLI::Option* option, bool is_positional) const override {
    constexpr std::string_view value = "{false}";
    std::string name = CLI::Formatter::make_option_name(option, is_positional);
    const auto at = name.find(value);
    return at == std::string::npos ? name : name.erase(at, value.size());
  }
};

// The default assumptions for the attitude unit and the rate unit together.
std::string assumed_by_default_of_units() {
  std::vector<std::string> words = assumption_words(Module::attitude_unit, true);
  for (const std::string& word : assumption_words(Module::rate_unit, true)) {
    if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
  }
  return fmt::format("{}", fmt::join(words, ","));
}

}  // namespace

std::string value_name(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.substr(0, std::min(type.find(':'), type.size()));
}

void use_plain_flag_names(CLI::App& app) { app.formatter(std::make_shared<PlainFlagNames>()); }

void add_examples(CLI::App& command, std::initializer_list<Example> examples) {
  std::string text = "\nExamples:\n";
  for (const auto& [line, what] : examples) text += fmt::format("  {}\n      {}\n", line, what);
  command.footer(text);
}

void add_port(CLI::App& command, const Globals& globals, HostOptions& host, Ports accepted) {
  host.barrier = globals.barrier;
  const std::string kinds = names_of_port_kinds(accepted == Ports::callable);
  CLI::Option* const option =
      command
          .add_option("--port", host.port,
                      fmt::format("Port to run: {}; `builtin` is the reference of attest", kinds))
          ->type_name("PORT")
          ->capture_default_str();
  if (accepted == Ports::any) return;
  option->check([](const std::string& given) -> std::string {
    if (kind_of(given).is_callable()) return "";
    return fmt::format(
        "{}: this command must call the port, and the outputs of a recorded port are files; use "
        "`attest run`",
        given);
  });
}

void add_timeout(CLI::App& command, double& timeout_s) {
  command
      .add_option("--timeout", timeout_s,
                  "Limit for each answer of the port [s]: a library answers with a whole trace, "
                  "a program with a step or a batch of steps. Counts the CPU time of the port's "
                  "processes; they may sleep three times as long")
      ->check(CLI::Range(0.1, 86400.0))
      ->capture_default_str()
      ->group(option_group::execution);
}

void add_page(CLI::App& command, std::string& file, const char* what) {
  command.add_option("--html", file, fmt::format("Write {}", what))
      ->type_name("F.html")
      ->group(option_group::reports);
}

void add_jobs(CLI::App& command, int& jobs, const char* what, const char* usual) {
  jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  command.add_option("--jobs,-j", jobs, fmt::format("{}; default: {}", what, usual))
      ->type_name("N")
      ->check(CLI::Range(1, 1024))
      ->group(option_group::execution);
}

CLI::Option* add_rates(CLI::App& command, std::vector<std::string>& rates, const char* what) {
  return command.add_option("--rate,--rates", rates, what)
      ->type_name("HZ,...")
      ->delimiter(',')
      ->allow_extra_args(false);
}

void add_plant(CLI::App& command, std::string& vehicle, std::string& plant,
               const char* usual_vehicle, const char* usual_plant) {
  command
      .add_option(
          "--vehicle", vehicle,
          fmt::format("Vehicle, one of `attest list --vehicles`; default: {}", usual_vehicle))
      ->type_name("VEHICLE");
  command
      .add_option("--plant", plant,
                  fmt::format("Plant: `mujoco` or `ode`; default: {}", usual_plant))
      ->type_name("PLANT");
}

void add_selection(CLI::App& command, SelectionOptions& options, Selects selects) {
  const auto add = [&](const char* name, std::vector<std::string>& values, const char* what,
                       const char* type) {
    return command.add_option(name, values, what)
        ->type_name(type)
        ->allow_extra_args(false)
        ->group(option_group::selection);
  };
  const bool with_flights = selects == Selects::all_vectors;
  add("--filter", options.filters,
      with_flights ? "Only vectors whose id matches this shell pattern: "
                     "PROFILE/GROUP/NAME@RATEhz, for a flight "
                     "PROFILE/GROUP/NAME@RATEhz-VEHICLE-PLANT; PROFILE/ and the part from @ on "
                     "are optional"
                   : "Only vectors whose id matches this shell pattern: "
                     "PROFILE/GROUP/NAME@RATEhz; PROFILE/ and @RATEhz are optional",
      "GLOB");
  add("--exclude", options.excludes, "Leave out the vectors whose id matches this shell pattern",
      "GLOB");
  add("--group", options.groups, "Only these groups of cases, separated by commas", "GROUP")
      ->delimiter(',');
  add("--profile", options.profiles, "Only these versions of the law, separated by commas",
      "PROFILE")
      ->delimiter(',');
  add_rates(command, options.rates,
            with_flights ? "Only these loop rates [Hz], separated by commas; flights of v1.14 to "
                           "v1.16 have pairs such as 250:1000"
                         : "Only these loop rates [Hz], separated by commas")
      ->group(option_group::selection);
  if (!with_flights) return;
  add("--vehicle", options.vehicles, "Only flights of these vehicles, separated by commas",
      "VEHICLE")
      ->delimiter(',');
  add("--plant", options.plants, "Only flights on this plant: `mujoco` or `ode`", "PLANT")
      ->delimiter(',');
}

void add_assumed(CLI::App& command, std::vector<std::string>& assumed) {
  command
      .add_option(
          "--assume", assumed,
          fmt::format(
              "What was true in the flight where the log lacks a topic: some of {}; default "
              "for v1.5.5 and v1.3.4: {}; default for v1.14 to v1.16: {}",
              fmt::join(assumption_words(), ", "),
              fmt::join(assumption_words(Module::mc_att_control, true), ","),
              assumed_by_default_of_units()))
      ->type_name("WORD,...")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->group(option_group::logs);
}

}  // namespace attest::cli
