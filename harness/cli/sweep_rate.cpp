#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "harness/casefile/parse_limits.hpp"
#include "harness/cli/find_case.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/shared_arguments.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/cli/supported_profiles.hpp"
#include "harness/core/file.hpp"
#include "harness/core/interrupt.hpp"
#include "harness/measure/rate_sweep.hpp"
#include "harness/plant/vehicle_models.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/progress.hpp"
#include "harness/report/rate_sweep_document.hpp"

namespace attest::cli {
namespace {

struct RateSweepOptions {
  CaseChoice flight{"flight/tilt_step_30", ""};
  std::vector<std::string> rates = {"50", "100", "250", "500", "1000"};
  std::vector<std::string> vehicles, plants;  // empty: all of the case
  HostOptions host;
  int jobs = 1;
  std::string csv, html;
};

struct RateSweepPlan {
  Case the_case;
  std::vector<LoopRate> rates;
  HostOptions host;
  Declarations port;
  Jobs<RateSweepResult> jobs;
};

Result<std::vector<PlantConfiguration>> plant_configurations_of(const Case& the_case,
                                                                const RateSweepOptions& options) {
  std::vector<PlantConfiguration> plant_configurations;
  for (const PlantConfiguration& plant_configuration : the_case.flight->plant_configurations) {
    const auto wanted = [](const std::vector<std::string>& names, std::string_view name) {
      return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
    };
    if (wanted(options.vehicles, plant_configuration.vehicle) &&
        wanted(options.plants, name_of(plant_configuration.plant))) {
      plant_configurations.push_back(plant_configuration);
    }
  }
  if (!plant_configurations.empty()) return plant_configurations;
  return fail(
      fmt::format("{} has no run configuration with this vehicle and plant; see `attest list "
                  "--vehicles`, and the `vehicles` and `plants` of the case",
                  the_case.id()));
}

Result<RateSweepPlan> make_plan(const RateSweepOptions& options, const SuiteFolder& suite) {
  RateSweepPlan plan;
  auto rates = parse_rates(options.rates);
  if (!rates) return tl::unexpected(rates.error());
  plan.rates = *std::move(rates);
  plan.host = options.host;
  plan.host.stop = interrupted;
  const auto prepared = prepare_for_flight(options.flight, plan.rates.front(), suite, plan.host);
  if (!prepared) return tl::unexpected(prepared.error());
  auto the_case = find_flight(prepared->choice, plan.rates.front(), suite);
  if (!the_case) return tl::unexpected(the_case.error());
  for (LoopRate& rate : plan.rates) {
    rate = rate_of_flight(*the_case, rate);
    if (auto sane = check_rate(*the_case, rate); !sane) return tl::unexpected(sane.error());
    if (auto few = check_ticks(*the_case, rate); !few) return tl::unexpected(few.error());
  }
  const auto plant_configurations = plant_configurations_of(*the_case, options);
  if (!plant_configurations) return tl::unexpected(plant_configurations.error());
  VehicleModels vehicle_models(suite.models());
  for (const PlantConfiguration& plant_configuration : *plant_configurations) {
    auto vehicle_model = vehicle_models.get(plant_configuration.vehicle);
    if (!vehicle_model) return tl::unexpected(vehicle_model.error());
    plan.jobs.push_back(std::make_unique<RateSweepJob>(*the_case, plant_configuration, plan.rates,
                                                       *std::move(vehicle_model), plan.host));
  }
  plan.the_case = std::move(*the_case);
  plan.port = prepared->port;
  return plan;
}

int sweep_rate_command(const RateSweepOptions& options, const Globals& globals) {
  const auto suite = find_suite(globals.suite);
  if (!suite) return report_error(suite.error());
  const auto checked = check_outputs({options.csv, options.html},
                                     {options.host.port, {options.flight.name}}, globals.suite);
  if (!checked) return report_error(checked.error());
  auto csv = AtomicFile::open(options.csv);
  if (!csv) return report_error(csv.error());
  auto html = AtomicFile::open(options.html);
  if (!html) return report_error(html.error());
  const auto plan = make_plan(options, *suite);
  if (!plan) return report_error(plan.error());
  note_interrupts();
  Progress progress(plan->jobs.size() * (plan->rates.size() + 1),
                    Progress::on_stderr(globals.quiet));
  JobOptions<RateSweepResult> jobs;
  jobs.processes = options.jobs;
  jobs.on_result = [&](const RateSweepResult& found) { progress.add(found.result); };
  jobs.stop = interrupted;
  const JobResults<RateSweepResult> outcome = run_jobs(plan->jobs, jobs);
  progress.finish();
  if (interrupted()) return exit_interrupted;
  for (const Error& error : outcome.errors) report_error(error);
  if (!outcome.errors.empty()) return exit_usage;
  if (auto same = check_port(plan->host); !same) return report_error(same.error());
  // Files of an earlier command are kept if no flight has a result.
  const bool any_result =
      std::any_of(outcome.results.begin(), outcome.results.end(),
                  [](const RateSweepResult& found) { return is_judged(found.result.verdict); });
  if (!any_result) {
    return report_error(supported_instead(options.host, {plan->the_case.profile},
                                          hover_command("attest sweep-rate", globals,
                                                        options.flight.name, options.host.port))
                            .value_or(Error{"the port did not fly: " +
                                            reason_text(outcome.results.front().result)}));
  }

  const RateSweepRun run{options.host.port, plan->port, plan->the_case, plan->rates,
                         outcome.results};
  const Document document = rate_sweep_document(run);
  if (auto written = csv->commit(rate_sweep_csv(run)); !written) {
    return report_error(written.error());
  }
  if (!options.html.empty()) {
    if (auto written = html->commit(html_page(document)); !written) {
      return report_error(written.error());
    }
  }
  if (!globals.quiet) fmt::print("{}", render_text(document, terminal_style(stdout)));
  return fails_a_run(document.head.verdict) ? exit_failed : exit_ok;
}

}  // namespace

void add_sweep_rate(const CommandLine& line) {
  auto options = std::make_shared<RateSweepOptions>();
  const Command command =
      line.add("sweep-rate",
               "Find for each vehicle the lowest loop rate and the largest delay of the motor "
               "commands at which a flight keeps its bounds");
  add_case(command, options->flight, "case,--case",
           "The flight, whose metrics have the bounds: the name or id of a case, or a case file");
  add_rates(command, options->rates,
            "Loop rates at which the largest delay is searched [Hz]; for v1.14 to v1.18 "
            "pairs such as 250:1000")
      .shows_default("50,100,250,500,1000");
  command
      .option("--vehicle", options->vehicles,
              "Only this vehicle; default: all vehicles of the case")
      .type("VEHICLE")
      .one_each_time();
  command
      .option("--plant", options->plants,
              "Only this plant: `mujoco` or `ode`; default: all plants of the case")
      .type("PLANT")
      .one_each_time();
  add_port(command, options->host);
  add_port_argument(command, options->host);
  add_page(command, options->html, "a page with the limits, and with the metrics by rate");
  command.option("--csv", options->csv, "Write the table as CSV")
      .type("F.csv")
      .group(option_group::reports);
  add_timeout(command, options->host.timeout_s);
  add_jobs(command, options->jobs,
           "Number of pairs of vehicle and plant that fly at the same time");
  command.examples({{"attest sweep-rate --port lib:./libmine.so --vehicle iris",
                     "find the lowest rate and the largest delay for the Iris"}});
  command.runs(options, sweep_rate_command);
}

}  // namespace attest::cli
