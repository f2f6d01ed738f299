#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/json_text.hpp"
#include "harness/core/version.hpp"
#include "harness/report/shown_cost.hpp"
#include "harness/report/time_document.hpp"

namespace attest {
namespace {

using nlohmann::ordered_json;

// Adds the figure `name` of a cost: "max_ns", or "max_cycles".
void set_cost(const TimeRun& run, const char* name, Cost cost, ordered_json& out) {
  const bool are_counts = run.counter && run.counter->unit != CostUnit::nanoseconds;
  if (are_counts) out[fmt::format("{}_{}", name, name_of(run.counter->unit))] = cost.count();
  if (const auto ns = Shown(run.counter).in_ns(cost)) {
    out[fmt::format("{}_ns", name)] = static_cast<std::int64_t>(std::ceil(*ns));
  }
}

ordered_json json_of(const TimeRun& run, const VectorTimes& vector) {
  ordered_json out = {{"id", vector.result.id()},
                      {"module", name_of(vector.module)},
                      {"verdict", name_of(vector.result.verdict)}};
  if (!vector.is_timed()) return out;
  set_cost(run, "max", vector.slowest(), out);
  set_cost(run, "median", vector.median(), out);
  if (vector.stack_bytes) out["stack_bytes"] = *vector.stack_bytes;
  out["steps"] = vector.steps.size();
  out["worst_tick"] = vector.slowest_tick();
  return out;
}

ordered_json json_of(const TimeRun& run, const Histogram& steps) {
  ordered_json out = ordered_json::object();
  set_cost(run, "max", steps.max(), out);
  set_cost(run, "median", steps.percentile(0.5), out);
  set_cost(run, "min", steps.min(), out);
  set_cost(run, "p90", steps.percentile(0.9), out);
  set_cost(run, "p99", steps.percentile(0.99), out);
  set_cost(run, "p99_9", steps.percentile(0.999), out);
  out["steps"] = steps.count();
  return out;
}

ordered_json all_json(const TimeRun& run) {
  const CorpusTimes& times = run.times;
  ordered_json out = json_of(run, times.steps);
  out["clock_ns"] = times.clock.count();
  out["over_budget"] = times.steps.over_limit();
  if (const auto* most = times.with_most_stack()) out["stack_bytes"] = *most->stack_bytes;
  out["worst_tick"] = times.with_slowest_step()->slowest_tick();
  return out;
}

ordered_json modules_json(const TimeRun& run) {
  ordered_json out = ordered_json::object();
  for (const auto& [module, steps] : run.times.by_module()) {
    out[std::string(name_of(module))] = json_of(run, steps);
  }
  return out;
}

ordered_json periods_json(const TimeRun& run) {
  ordered_json out = ordered_json::array();
  for (const Period& one : periods_of(run)) {
    const VectorResult& result = one.slowest->result;
    out.push_back({{"module", name_of(one.module)},
                   {"rate_hz", result.rate.to_string()},
                   {"share", one.share},
                   {"vector", result.id()}});
  }
  return out;
}

ordered_json changes_json(const TimeRun& run) {
  ordered_json out = ordered_json::array();
  for (const CostChange& change : run.changes) {
    out.push_back({{"profile", change.group.profile},
                   {"module", change.group.module},
                   {"group", change.group.group},
                   {"rate_hz", change.group.rate_hz},
                   {"before", nullptr},
                   {"now", change.now.cost},
                   {"vector", change.now.vector},
                   {"fails", change.fails}});
    if (change.before) out.back()["before"] = *change.before;
  }
  return out;
}

ordered_json counter_json(const std::optional<CostCounter>& counter) {
  if (!counter) return nullptr;
  ordered_json out = {{"unit", name_of(counter->unit)}};
  if (counter->unit == CostUnit::cycles) out["clock_hz"] = counter->clock_hz;
  return out;
}

}  // namespace

std::string time_json(const TimeRun& run) {
  ordered_json out = {{"schema", "attest-time-1"},
                      {"attest_version", version},
                      {"port", run.port},
                      {"repeats", run.repeats},
                      {"budget_us", nullptr},
                      {"counter", counter_json(run.counter)},
                      {"budget_file", nullptr},
                      {"changes", changes_json(run)},
                      {"all", all_json(run)},
                      {"modules", modules_json(run)},
                      {"periods", periods_json(run)},
                      {"slowest", run.times.with_slowest_step()->result.id()},
                      {"instructions", run.instructions},
                      {"vectors", ordered_json::array()}};
  if (run.budget_us) out["budget_us"] = *run.budget_us;
  if (!run.budget_file.empty()) out["budget_file"] = run.budget_file;
  for (const VectorTimes& vector : run.times.vectors) {
    out["vectors"].push_back(json_of(run, vector));
  }
  return document_of(out);
}

}  // namespace attest
