#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include <fmt/format.h>

#include "harness/casefile/parse.hpp"
#include "harness/cli/command.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/suite/sim_batch.hpp"

namespace attest::cli {
namespace {

// `name` is a case file, or the pattern of exactly one case.
Result<Case> find_case(const std::string& name, const SuiteFolder& suite) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(name, ignored)) return parse_case(name);
  Selection selection;
  selection.filters = {name};
  const auto found = select_cases(suite.cases(), selection);
  if (!found) return tl::unexpected(found.error());
  if (found->size() == 1) return found->front().the_case;
  return fail(fmt::format("`{}` names {} cases, the first {} and {}; name one", name, found->size(),
                          (*found)[0].the_case.id(), (*found)[1].the_case.id()));
}

// What the case flies first, where the command line leaves it open.
Result<Flyer> find_flyer(const Case& the_case, const SimOptions& options) {
  Flyer flyer{options.vehicle.empty() ? the_case.flight->lead_vehicle : options.vehicle,
              the_case.flight->flyers.front().plant};
  if (options.plant.empty()) return flyer;
  const auto plant = parse_plant_kind(options.plant);
  if (!plant) return tl::unexpected(plant.error());
  flyer.plant = *plant;
  return flyer;
}

struct Sim {
  Case the_case;
  Setup setup;
  std::shared_ptr<const Airframe> airframe;
};

Result<Sim> prepare(const SimOptions& options, const Globals& globals) {
  const auto suite = find_suite(globals.suite);
  if (!suite) return tl::unexpected(suite.error());
  const auto rate = Rate::parse(options.rate);
  if (!rate) return tl::unexpected(rate.error());
  auto the_case = find_case(options.case_name, *suite);
  if (!the_case) return tl::unexpected(the_case.error());
  if (!the_case->flight) {
    return fail_at(the_case->file.string(),
                   "has no [flight]: its inputs are scripted; `attest run` runs it");
  }
  const auto flyer = find_flyer(*the_case, options);
  if (!flyer) return tl::unexpected(flyer.error());
  auto airframe = Airframe::load(suite->models(), flyer->vehicle);
  if (!airframe) return tl::unexpected(airframe.error());
  return Sim{std::move(*the_case), {*rate, *flyer}, std::move(*airframe)};
}

std::string bounds(const MetricResult& metric) {
  if (std::isinf(metric.min)) return fmt::format("at most {:g}", metric.max);
  if (std::isinf(metric.max)) return fmt::format("at least {:g}", metric.min);
  return fmt::format("{:g} to {:g}", metric.min, metric.max);
}

void print(const CaseResult& result, const std::string& out) {
  fmt::print("{}  {} ticks -> {}\n", result.id(), result.ticks, out);
  if (!result.reason.empty()) fmt::print("  {}: {}\n", name_of(result.verdict), result.reason);
  for (const MetricResult& metric : result.metrics) {
    fmt::print("  {:<20} {:<24}{:>10.4g}  {}{}\n", metric.name, name_of(metric.measure),
               metric.value, bounds(metric), metric.within() ? "" : "  MISSED");
  }
}

}  // namespace

int sim_command(const SimOptions& options, const Globals& globals) {
  auto sim = prepare(options, globals);
  if (!sim) return report_error(sim.error());
  Batches batches;
  batches.push_back(std::make_unique<SimBatch>(std::move(sim->the_case), std::move(sim->setup),
                                               std::move(sim->airframe), options.out));
  WorkerOptions worker;
  worker.port = options.port;
  worker.timeout_s = options.timeout_s;
  const WorkerOutcome outcome = run_batches(batches, worker);
  if (!outcome.errors.empty()) return report_error(outcome.errors.front());
  const CaseResult& result = outcome.results.front();
  if (!globals.quiet || result.verdict != Verdict::pass) print(result, options.out);
  return result.verdict == Verdict::pass ? exit_ok : exit_failed;
}

}  // namespace attest::cli
