#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/json_text.hpp"
#include "harness/core/version.hpp"
#include "harness/measure/stress_json.hpp"
#include "harness/report/stress_document.hpp"

namespace attest {
namespace {

// The result of the rate unit comes before that of the attitude unit of the same flight.
bool is_of_same_flight(const StressResult& before, const StressResult& next) {
  return before.module == Module::rate_unit && next.module == Module::attitude_unit &&
         before.result.rate == next.result.rate;
}

int gravity(Verdict verdict) { return fails_a_run(verdict) ? 2 : verdict == Verdict::pass ? 0 : 1; }

std::string reason_of(const StressResult& stress) {
  const std::string& reason = stress.result.reason;
  return stress.module && !reason.empty()
             ? fmt::format("{}: {}", info_of(*stress.module).title, reason)
             : reason;
}

// Adds the result of a unit to `all`, the result of the flight so far.
void add_unit(const StressResult& unit, VectorResult& all) {
  const std::string before = all.reason, reason = reason_of(unit);
  if (gravity(unit.result.verdict) > gravity(all.verdict)) all = unit.result;
  all.reason = fmt::format("{}{}{}", before, before.empty() || reason.empty() ? "" : "; ", reason);
}

}  // namespace

std::vector<std::string> rates_not_judged(const StressRun& run) {
  std::vector<std::string> rates;
  for (const VectorResult& result : run_of(run).results) {
    if (!is_judged(result.verdict)) rates.push_back(result.rate.to_string());
  }
  return rates;
}

Conclusion conclusion_of(const StressRun& run) {
  const RunResult all = run_of(run);
  if (all.failed()) return Conclusion::fail;
  if (all.count(Verdict::pass) == 0) return Conclusion::none;
  const bool complete = all.count(Verdict::pass) == all.results.size() && !run.interrupted;
  return complete ? Conclusion::pass : Conclusion::partial;
}

std::string note_on_cost(const StressRun& run) {
  const auto& counter = run.description.cost;
  if (!counter || !counter->unit_ns()) return "";
  return fmt::format(
      "the port counts its execution times, in {}; all other times are those of this machine",
      counter->to_string());
}

std::string note_on_units(const StressRun& run) {
  for (const StressResult& stress : run.results) {
    if (!stress.module) continue;
    const Module other =
        *stress.module == Module::rate_unit ? Module::attitude_unit : Module::rate_unit;
    if (contains(run.description.modules, other)) return "";
    return fmt::format("the {} is that of the reference, because the port has none: not judged",
                       info_of(other).title);
  }
  return "";
}

RunResult run_of(const StressRun& run) {
  RunResult all;
  all.attest_version = version;
  all.suite_folder = run.suite_folder;
  all.port = run.port;
  all.port_name = run.description.name;
  all.port_version = run.description.version;
  all.fraction_bits = run.description.fraction_bits;
  all.fixed_step = run.description.fixed_step;
  all.command = "stress";
  for (std::size_t i = 0; i < run.results.size(); ++i) {
    const StressResult& stress = run.results[i];
    if (i > 0 && is_of_same_flight(run.results[i - 1], stress)) {
      add_unit(stress, all.results.back());
      continue;
    }
    all.results.push_back(stress.result);
    all.case_files[stress.result.case_id()] = run.case_file;
    all.results.back().reason = reason_of(stress);
    all.rates.push_back(stress.result.rate);
  }
  all.stopped_early = run.interrupted;
  return all;
}

std::string stress_json(const StressRun& run) {
  nlohmann::ordered_json out = {{"schema", "attest-stress-1"},
                                {"attest_version", version},
                                {"port", run.port},
                                {"load", run.load},
                                {"unit_cpu", run.live.unit_cpu},
                                {"plant_cpu", run.live.plant_cpu},
                                {"policy", run.live.fifo ? "fifo" : "other"},
                                {"spin_ns", run.live.wait.spin.count()},
                                {"interrupted", run.interrupted},
                                {"verdict", name_of(conclusion_of(run))},
                                {"rates_not_judged", rates_not_judged(run)},
                                {"results", nlohmann::json::array()}};
  for (const StressResult& stress : run.results) {
    out["results"].push_back(nlohmann::ordered_json(to_json(stress)));
  }
  return document_of(out);
}

}  // namespace attest
