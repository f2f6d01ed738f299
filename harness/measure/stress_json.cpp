#include "harness/measure/stress_json.hpp"

#include <cstdint>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/json_reader.hpp"
#include "harness/core/printable.hpp"
#include "harness/verify/verdict_json.hpp"

namespace attest {
namespace {

using nlohmann::json;

// Calls `visit(key, member)` for each member. Writing (Put) and reading (Get) use the same list.
template <typename SpreadT, typename Visit>
void members_of_spread(SpreadT& spread, Visit&& visit) {
  visit("count", spread.count);
  visit("min_ns", spread.min);
  visit("median_ns", spread.median);
  visit("p90_ns", spread.p90);
  visit("p99_ns", spread.p99);
  visit("p99_9_ns", spread.p999);
  visit("max_ns", spread.max);
  visit("buckets", spread.buckets);
}

template <typename UsageT, typename Visit>
void members_of_usage(UsageT& usage, Visit&& visit) {
  visit("cpu_ns", usage.cpu);
  visit("allocations", usage.allocations);
  visit("page_faults", usage.page_faults);
  visit("yields", usage.yields);
  visit("preemptions", usage.preemptions);
}

template <typename StressT, typename Visit>
void numbers_of(StressT& stress, Visit&& visit) {
  visit("deadlines", stress.deadlines);
  visit("ticks", stress.ticks);
  visit("late_responses", stress.misses.late);
  visit("skipped_releases", stress.misses.skipped);
  visit("deadline_misses_by_port", stress.misses.by_port);
  visit("late_starts", stress.misses.late_starts);
  visit("late_starts_by_port", stress.misses.late_starts_by_port);
  visit("overruns", stress.overruns);
  visit("waiting_steps", stress.waiting_steps);
  visit("plant_steps", stress.plant_steps);
  visit("plant_late_steps", stress.plant_late_steps);
  visit("longest_gap_ns", stress.longest_gap);
  visit("wall_ns", stress.wall);
}

template <typename StressT, typename Visit>
void spreads_of(StressT& stress, Visit&& visit) {
  visit("idle_wake_up_latency", stress.idle);
  visit("wake_up_latency", stress.latency);
  visit("execution_time", stress.execution);
  visit("response_time", stress.response);
  visit("sample_age", stress.age);
  visit("plant_wake_up_latency", stress.plant);
}

using Buckets = std::vector<Histogram::Bucket>;

struct Put {
  json& out;
  void operator()(const char* key, const Buckets& buckets) const {
    out[key] = json::array();
    for (const auto& [from, to, count] : buckets) {
      out[key].push_back({{"from_ns", from.count()}, {"below_ns", to.count()}, {"count", count}});
    }
  }
  void operator()(const char* key, const std::optional<Nanoseconds>& time) const {
    if (time) out[key] = time->count();
  }
  void operator()(const char* key, Nanoseconds time) const { out[key] = time.count(); }
  template <typename Number>
  void operator()(const char* key, const Number& number) const {
    out[key] = number;
  }
};

// Longer than any measurement. Sums of such times fit into 64 bits.
constexpr std::int64_t longest_ns = 1'000'000'000'000'000;

Nanoseconds time_from(JsonReader& in, const char* key) {
  return Nanoseconds(in.integer(key, 0, longest_ns));
}

// Reports members that are missing, of another type or out of range to the reader.
struct Get {
  JsonReader& in;
  std::string& error;
  void operator()(const char* key, Buckets& buckets) const {
    for (const json& one : in.list(key)) {
      JsonReader bucket(one, error);
      buckets.push_back({time_from(bucket, "from_ns"), time_from(bucket, "below_ns"),
                         bucket.count("count", INT64_MAX)});
    }
  }
  void operator()(const char* key, std::optional<Nanoseconds>& time) const {
    if (in.has(key)) time = time_from(in, key);
  }
  void operator()(const char* key, Nanoseconds& time) const { time = time_from(in, key); }
  template <typename Number>
  void operator()(const char* key, Number& number) const {
    number = static_cast<Number>(in.count(key, INT64_MAX));
  }
};

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

SlowTicks slow_from_json(JsonReader in, std::string& error) {
  SlowTicks slow;
  slow.threshold = time_from(in, "threshold_ns");
  slow.count = in.count("count", INT64_MAX);
  for (const json& one : in.list("worst")) {
    JsonReader tick(one, error);
    slow.worst.push_back({tick.count("tick", INT64_MAX), time_from(tick, "execution_time_ns"),
                          time_from(tick, "elapsed_ns")});
  }
  if (!in.has("rhythm")) return slow;
  JsonReader rhythm = in.object("rhythm");
  slow.rhythm = Rhythm{rhythm.count("every_steps", INT64_MAX),
                       rhythm.count("first_tick", INT64_MAX), rhythm.real("chance_at_most")};
  return slow;
}

StressResult read(JsonReader in, std::string& error) {
  StressResult stress;
  numbers_of(stress, Get{in, error});
  spreads_of(stress, [&](const char* key, Percentiles& spread) {
    JsonReader of_spread = in.object(key);
    members_of_spread(spread, Get{of_spread, error});
  });
  JsonReader unit = in.object("unit"), plant = in.object("plant");
  members_of_usage(stress.unit_usage, Get{unit, error});
  members_of_usage(stress.plant_usage, Get{plant, error});
  for (const json& one : in.list("privileges")) {
    JsonReader right(one, error);
    stress.privileges.push_back(
        {printable_part(right.text("name")), right.flag("got"), printable_part(right.text("why"))});
  }
  stress.slow = slow_from_json(in.object("slow_steps"), error);
  if (!in.has("module")) return stress;
  stress.module = module_named(in.text("module"));
  if (!stress.module) in.wrong("module", "is no module");
  return stress;
}

}  // namespace

json to_json(const StressResult& stress) {
  json out = {{"result", to_json(stress.result)}, {"slow_steps", slow_to_json(stress.slow)}};
  if (stress.module) out["module"] = name_of(*stress.module);
  numbers_of(stress, Put{out});
  out["deadline_misses"] = stress.misses.total();
  spreads_of(stress, [&](const char* key, const Percentiles& spread) {
    members_of_spread(spread, Put{out[key]});
  });
  members_of_usage(stress.unit_usage, Put{out["unit"]});
  members_of_usage(stress.plant_usage, Put{out["plant"]});
  out["privileges"] = json::array();
  for (const auto& [name, got, why] : stress.privileges) {
    out["privileges"].push_back({{"name", name}, {"got", got}, {"why", why}});
  }
  if (const auto& cyclictest = stress.cyclictest) {
    out["cyclictest"] = {{"median_ns", cyclictest->median.count()},
                         {"max_ns", cyclictest->max.count()},
                         {"cycles", cyclictest->cycles}};
  }
  return out;
}

Result<StressResult> stress_from_json(const json& in) {
  if (!in.is_object() || !in.contains("result")) return fail("not the result of a stress run");
  auto result = vector_result_from_json(in["result"]);
  if (!result) return tl::unexpected(result.error());
  std::string error;
  StressResult stress = read(JsonReader(in, error), error);
  if (!error.empty()) return fail(fmt::format("not the result of a stress run: {}", error));
  stress.result = std::move(*result);
  return stress;
}

}  // namespace attest
