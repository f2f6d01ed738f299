#include "harness/measure/stress_json.hpp"

#include <utility>

#include <nlohmann/json.hpp>

#include "harness/host/live_message.hpp"
#include "harness/verify/verdict_json.hpp"

namespace attest {
namespace {

using nlohmann::json;

json to_json(const Percentiles& spread) {
  json out = {{"count", spread.count},
              {"min_ns", spread.min.count()},
              {"max_ns", spread.max.count()},
              {"buckets", json::array()}};
  for (const auto& [key, percentile] : {std::pair("median_ns", spread.median),
                                        {"p90_ns", spread.p90},
                                        {"p99_ns", spread.p99},
                                        {"p99_9_ns", spread.p999}}) {
    if (percentile) out[key] = percentile->count();
  }
  for (const auto& [from, to, count] : spread.buckets) {
    out["buckets"].push_back(
        {{"from_ns", from.count()}, {"below_ns", to.count()}, {"count", count}});
  }
  return out;
}

json slow_to_json(const SlowTicks& slow) {
  json worst = json::array();
  for (const auto& [tick, execution, elapsed] : slow.worst) {
    worst.push_back({{"tick", tick},
                     {"execution_time_ns", execution.count()},
                     {"elapsed_ns", elapsed.count()}});
  }
  json out = {{"threshold_ns", slow.threshold.count()}, {"count", slow.count}, {"worst", worst}};
  if (const auto& rhythm = slow.rhythm) {
    out["rhythm"] = {{"every_steps", rhythm->every},
                     {"first_tick", rhythm->first},
                     {"chance_at_most", rhythm->chance}};
  }
  return out;
}

}  // namespace

json to_json(const StressResult& stress) {
  json out = {{"result", to_json(stress.result)},
              {"deadlines", stress.deadlines},
              {"ticks", stress.ticks},
              {"late_responses", stress.misses.late},
              {"skipped_releases", stress.misses.skipped},
              {"deadline_misses", stress.misses.total()},
              {"deadline_misses_by_port", stress.misses.by_port},
              {"late_starts", stress.misses.late_starts},
              {"late_starts_by_port", stress.misses.late_starts_by_port},
              {"overruns", stress.overruns},
              {"waiting_steps", stress.waiting_steps},
              {"plant_steps", stress.plant_steps},
              {"plant_late_steps", stress.plant_late_steps},
              {"longest_gap_ns", stress.longest_gap.count()},
              {"wall_ns", stress.wall.count()},
              {"idle_wake_up_latency", to_json(stress.idle)},
              {"wake_up_latency", to_json(stress.latency)},
              {"execution_time", to_json(stress.execution)},
              {"response_time", to_json(stress.response)},
              {"sample_age", to_json(stress.age)},
              {"plant_wake_up_latency", to_json(stress.plant)},
              {"unit", to_json(stress.unit_usage)},
              {"plant", to_json(stress.plant_usage)},
              {"privileges", to_json(stress.privileges)},
              {"slow_steps", slow_to_json(stress.slow)}};
  if (stress.module) out["module"] = name_of(*stress.module);
  if (const auto& cyclictest = stress.cyclictest) {
    out["cyclictest"] = {{"median_ns", cyclictest->median.count()},
                         {"max_ns", cyclictest->max.count()},
                         {"cycles", cyclictest->cycles}};
  }
  return out;
}

}  // namespace attest
