#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "harness/casefile/parse_limits.hpp"
#include "harness/cli/find_case.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/cli/supported_profiles.hpp"
#include "harness/core/file.hpp"
#include "harness/golden/reference.hpp"
#include "harness/host/file_format.hpp"
#include "harness/loop/case_timing.hpp"
#include "harness/port/profiles.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/flight_document.hpp"
#include "harness/report/text.hpp"
#include "harness/verify/fixed_step.hpp"
#include "harness/verify/simulate.hpp"

namespace attest::cli {
namespace {

struct SimOptions {
  CaseChoice flight;  // with `rate`; empty with `timing`
  std::string rate;
  std::string vehicle, plant;  // empty: the lead vehicle and the first plant of the case
  std::string timing;
  HostOptions host;
  std::string out, html;  // files; may be empty
};

constexpr std::string_view all_plants = "all";
// Without --rate; those of most flights of PX4.
constexpr const char* default_rate = "250";
constexpr const char* default_rates_of_units = "250:1000";

constexpr const char* outputs_deviate = "outputs deviate from the reference's for the same inputs";

// The same flight on one plant or on several.
struct Sim {
  Case the_case;
  std::vector<RunConfiguration> configurations;
  FlightTiming timing;
  std::shared_ptr<const VehicleModel> vehicle_model;
};

Result<Sim> prepare_timed(const SimOptions& options, const SuiteFolder& suite) {
  if (!options.flight.name.empty() || !options.flight.profile.empty() || !options.rate.empty() ||
      !options.vehicle.empty() || !options.plant.empty()) {
    return fail("--timing sets case, profile, rate, vehicle and plant; leave them out");
  }
  auto flight = find_timed_flight(options.timing, suite);
  if (!flight) return tl::unexpected(flight.error());
  return Sim{std::move(flight->the_case),
             {flight->timing.configuration},
             std::move(flight->timing.ticks),
             std::move(flight->vehicle_model)};
}

Result<Sim> prepare_case(const SimOptions& options, const SuiteFolder& suite) {
  if (options.flight.name.empty()) return fail("needs a case, or --timing");
  const bool on_all = options.plant == all_plants;
  if (on_all && !options.out.empty()) {
    return fail("--out writes one flight; name its plant instead of `all`");
  }
  auto rate = LoopRate::parse(options.rate.empty() ? default_rate : options.rate);
  if (!rate) return tl::unexpected(rate.error());
  auto chosen =
      choose_flight(options.flight, *rate, options.vehicle, on_all ? "" : options.plant, suite);
  if (!chosen) return tl::unexpected(chosen.error());
  const bool has_two_units = chosen->the_case.attitude_loop.has_value();
  if (options.rate.empty() && has_two_units) rate = LoopRate::parse(default_rates_of_units);
  rate = rate_of_flight(chosen->the_case, *rate);
  if (auto few = check_ticks(chosen->the_case, *rate); !few) return tl::unexpected(few.error());
  std::vector<RunConfiguration> configurations;
  for (const PlantKind plant : plant_kinds) {
    const PlantConfiguration& one = chosen->plant_configuration;
    if (on_all || plant == one.plant) {
      configurations.push_back({*rate, PlantConfiguration{one.vehicle, plant}});
    }
  }
  FlightTiming timing = flight_timing(chosen->the_case, *rate);
  return Sim{std::move(chosen->the_case), std::move(configurations), std::move(timing),
             std::move(chosen->vehicle_model)};
}

Result<Sim> prepare(const SimOptions& options, const Globals& globals) {
  const auto suite = find_suite(globals.suite);
  if (!suite) return tl::unexpected(suite.error());
  const auto checked =
      check_outputs({options.out, attitude_unit_file(options.out), options.html},
                    {options.host.port, {options.timing, options.flight.name}}, globals.suite);
  if (!checked) return tl::unexpected(checked.error());
  if (!options.timing.empty()) return prepare_timed(options, *suite);
  return prepare_case(options, *suite);
}

// Opened before the port's code runs.
struct SimFiles {
  AtomicFile out, attitude, html;

  static Result<SimFiles> open(const SimOptions& options) {
    auto out = AtomicFile::open(options.out);
    if (!out) return tl::unexpected(out.error());
    auto attitude = AtomicFile::open(attitude_unit_file(options.out));
    if (!attitude) return tl::unexpected(attitude.error());
    auto html = AtomicFile::open(options.html);
    if (!html) return tl::unexpected(html.error());
    return SimFiles{*std::move(out), *std::move(attitude), *std::move(html)};
  }
};

// Each flight has a fresh process of the port.
Result<std::vector<SimulatedFlight>> fly_all(const Sim& sim, const HostOptions& options) {
  std::vector<SimulatedFlight> flights;
  for (const RunConfiguration& configuration : sim.configurations) {
    const auto host = start_host(options, {&sim.the_case, sim.vehicle_model.get()});
    if (!host) return tl::unexpected(host.error());
    auto flight = simulate_flight(sim.the_case, {configuration, sim.timing}, **host);
    if (!flight) return tl::unexpected(flight.error());
    flights.push_back(*std::move(flight));
  }
  return flights;
}

// The same flight in a profile that the port supports. Empty: flight_for_port() finds none.
std::optional<Sim> flight_of_port(const SimOptions& options, const Sim& sim,
                                  const Globals& globals) {
  const auto suite = find_suite(globals.suite);
  if (!options.timing.empty() || !suite) return std::nullopt;
  const auto rate = LoopRate::parse(options.rate.empty() ? default_rate : options.rate);
  const auto flight = flight_for_port(options.flight, sim.the_case, *rate, *suite, options.host);
  if (!flight) return std::nullopt;
  SimOptions in_profile = options;
  in_profile.flight = *flight;
  auto other = prepare_case(in_profile, *suite);
  return other ? std::optional(*std::move(other)) : std::nullopt;
}

// The flights and their document.
struct Simulation {
  std::vector<SimulatedFlight> flights;
  Document document;
};

// Finds the first deviations of the flights, and returns notes about them.
Result<std::vector<Note>> note_all_deviations(const Sim& sim, const Declarations& port,
                                              std::vector<SimulatedFlight>& flights) {
  std::vector<Note> notes;
  for (SimulatedFlight& flight : flights) {
    auto noted = note_deviations(sim.the_case, port, flight);
    if (!noted) return tl::unexpected(noted.error());
    const auto& first = flight.result.first;
    if (!first) continue;
    notes.push_back({fmt::format("{}: {}, first at tick {}. The verdict is of the metrics.",
                                 flight.result.id(), outputs_deviate, first->tick),
                     true, false});
  }
  return notes;
}

// With `has_page` the reference flies as well, on the first plant.
Result<Simulation> simulate(const Sim& sim, const HostOptions& options, const Declarations& port,
                            bool has_page) {
  auto flights = fly_all(sim, options);
  if (!flights) return tl::unexpected(flights.error());
  FlightBackground background;
  std::vector<Note> notes;
  if (options.port != HostOptions().port) {  // not the reference itself
    auto noted = note_all_deviations(sim, port, *flights);
    if (!noted) return tl::unexpected(noted.error());
    notes = *std::move(noted);
    if (has_page) {
      auto right =
          open_reference({&sim.the_case, sim.vehicle_model.get()})
              ->fly({sim.configurations.front(), sim.timing, has_fixed_step(port, sim.the_case)});
      if (!right) return tl::unexpected(right.error());
      background.reference = *std::move(right);
    }
  }
  background.marks = marks_of(sim.the_case, flights->front());
  background.metrics = sim.the_case.flight->metrics;
  Document document = flight_document(*flights, port, background);
  document.notes.insert(document.notes.end(), notes.begin(), notes.end());
  return Simulation{*std::move(flights), std::move(document)};
}

Result<void> write(const std::vector<SimulatedFlight>& flights, const Document& document,
                   SimFiles files) {
  const Flown& flown = flights.front().flown;
  if (!files.out.path().empty() && !flown.trace.samples.empty()) {
    if (auto written = write_trace(std::move(files.out), flown.trace); !written) return written;
    if (flown.attitude_trace && !files.attitude.path().empty()) {
      auto written = write_trace(std::move(files.attitude), *flown.attitude_trace);
      if (!written) return written;
    }
  }
  if (files.html.path().empty()) return {};
  return files.html.commit(html_page(document));
}

void print(const VectorResult& result, const SimOptions& options, bool is_written, std::FILE* to) {
  std::vector<std::string> files;
  if (result.ticks > 0 && !options.out.empty()) {
    files.push_back(options.out);
    if (result.rate.attitude_unit) files.push_back(attitude_unit_file(options.out));
  }
  if (is_written) files.push_back(options.html);
  std::erase_if(files, [](const std::string& file) { return file.empty() || file == "-"; });
  fmt::print(to, "{}  {} ticks{}{}\n", result.id(), result.ticks, files.empty() ? "" : " -> ",
             fmt::join(files, ", "));
  if (!result.reason.empty()) fmt::print(to, "  {}: {}\n", name_of(result.verdict), result.reason);
  if (result.first) fmt::print(to, "{}:\n", outputs_deviate);
  fmt::print(to, "{}", finding_text(result, Level::numeric));
}

int sim_command(const SimOptions& options, const Globals& globals) {
  auto sim = prepare(options, globals);
  if (!sim) return report_error(sim.error());
  auto files = SimFiles::open(options);
  if (!files) return report_error(files.error());
  HostOptions host = options.host;
  const auto port = prepare_port(host, {sim->the_case.profile});
  if (!port) return report_error(port.error());
  if (supports_none(*port)) {
    if (auto other = flight_of_port(options, *sim, globals)) sim = *std::move(other);
  }
  const auto simulation = simulate(*sim, host, *port, !options.html.empty());
  if (!simulation) return report_error(simulation.error());
  const auto& [flights, document] = *simulation;
  if (auto same = check_port(host); !same) return report_error(same.error());
  // Files of an earlier command are kept if no flight has a result.
  const bool any_result =
      std::any_of(flights.begin(), flights.end(),
                  [](const SimulatedFlight& flight) { return is_judged(flight.result.verdict); });
  const auto written = any_result ? write(flights, document, *std::move(files)) : Result<void>();
  if (!written) return report_error(written.error());
  std::FILE* const to = options.out == "-" || options.html == "-" ? stderr : stdout;
  bool any_fails = false, any_shown = false;
  for (const SimulatedFlight& flight : flights) {
    const Verdict verdict = flight.result.verdict;
    const bool is_shown = !globals.quiet || verdict != Verdict::pass;
    if (is_shown) print(flight.result, options, any_result, to);
    any_shown = any_shown || is_shown;
    any_fails = any_fails || fails_a_run(verdict);
  }
  if (any_shown) {
    for (const DocumentTable& table : document.tables) fmt::print(to, "{}", render_text(table, {}));
  }
  if (any_shown && any_result) {
    fmt::print(to, "{} ({})\n",
               flight_conclusion(flights, document, host.port == HostOptions().port), host.port);
  }
  if (!any_result) {
    return report_error(supported_instead(options.host, {sim->the_case.profile},
                                          hover_command("attest sim", globals, options.flight.name,
                                                        options.host.port))
                            .value_or(Error{"the port did not fly: no flight has a result"}));
  }
  return any_fails ? exit_failed : exit_ok;
}

}  // namespace

void add_sim(const CommandLine& line) {
  auto options = std::make_shared<SimOptions>();
  const Command command =
      line.add("sim",
               "Fly one case in simulation with a port, print the metrics, and write a trace or "
               "a page of the flight");
  add_case(command, options->flight, "case,--case");
  command
      .option("--rate", options->rate,
              "Loop rate [Hz]; for v1.14 to v1.18 the rates of both units, such as 250:1000, or "
              "that of the rate unit, with the attitude unit at 250; default: 250, and 250:1000")
      .type("HZ");
  command
      .option("--timing", options->timing,
              "Fly the flight of this file from --record-timing again, at the recorded "
              "times; it replaces CASE, --rate, --vehicle and --plant")
      .type("F");
  add_plant(command, options->vehicle, options->plant);
  command.find("--plant").description(
      "Plant: `mujoco` or `ode`, or `all` for a page (--html) with the flights on "
      "both; default: the first plant of the case");
  add_port(command, options->host);
  add_port_argument(command, options->host);
  command
      .option("--out", options->out,
              fmt::format("Write the trace as CSV, or in the format of the name's ending ({}); for "
                          "v1.14 to v1.18, F.csv has the rate unit and F.attitude_unit.csv the "
                          "attitude unit",
                          written_endings()))
      .type("F");
  add_page(command, options->html,
           "a page with plots of the flight and an animation of the attitude");
  add_timeout(command, options->host.timeout_s);
  command.examples({{"attest sim hover", "hover with the Iris on MuJoCo, and print the metrics"},
                    {"attest sim hover ./libmine.so", "the same with a port"},
                    {"attest sim hover --rate 250 --port lib:./libmine.so --out flown.csv",
                     "at another rate, and write a trace"},
                    {"attest sim gust --rate 500 --vehicle hexa --plant ode --out flown.csv",
                     "another vehicle and another plant"},
                    {"attest sim flip_150_level --rate 250 --html flight.html",
                     "the flight as a page with plots"},
                    {"attest sim gust --rate 250 --plant all --html flight.html",
                     "the flights on both plants in the same plots"}});
  command.runs(options, sim_command);
}

}  // namespace attest::cli
