#include "harness/report/time_text.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/core/json_text.hpp"
#include "harness/core/version.hpp"
#include "harness/report/stress_text.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

constexpr std::size_t slowest_shown = 5;

std::vector<const VectorTimes*> timed(const CorpusTimes& times) {
  std::vector<const VectorTimes*> vectors;
  for (const VectorTimes& vector : times.vectors) {
    if (vector.is_timed()) vectors.push_back(&vector);
  }
  return vectors;
}

std::string slowest(const CorpusTimes& times) {
  std::vector<const VectorTimes*> order = timed(times);
  std::stable_sort(order.begin(), order.end(), [](const VectorTimes* a, const VectorTimes* b) {
    return a->slowest() > b->slowest();
  });
  std::string out;
  for (std::size_t i = 0; i < std::min(order.size(), slowest_shown); ++i) {
    out += fmt::format("  {:>9}  {} tick {}\n", human_time(order[i]->slowest()),
                       one_line(order[i]->result.id()), order[i]->slowest_tick());
  }
  return out;
}

std::string stack(const CorpusTimes& times) {
  const VectorTimes* most = times.with_most_stack();
  if (!most) return "";
  return fmt::format("stack of a step: at most {} bytes ({})\n", *most->stack_bytes,
                     one_line(most->result.id()));
}

std::string instructions(std::vector<std::uint64_t> calls) {
  if (calls.empty()) return "";
  const auto worst = std::max_element(calls.begin(), calls.end()) - calls.begin();
  const std::uint64_t most = calls[static_cast<std::size_t>(worst)];
  std::sort(calls.begin(), calls.end());
  return fmt::format(
      "instructions of the slowest vector's steps, the same on every run: least {}, "
      "median {}, most {} (tick {})\n",
      calls.front(), calls[calls.size() / 2], most, worst);
}

using nlohmann::ordered_json;

ordered_json json_of(const VectorTimes& vector) {
  ordered_json out = {{"id", vector.result.id()},
                      {"module", name_of(vector.module)},
                      {"verdict", name_of(vector.result.verdict)}};
  if (!vector.is_timed()) return out;
  out["max_ns"] = vector.slowest().count();
  out["median_ns"] = vector.median().count();
  if (vector.stack_bytes) out["stack_bytes"] = *vector.stack_bytes;
  out["steps"] = vector.steps.size();
  out["worst_tick"] = vector.slowest_tick();
  return out;
}

ordered_json json_of(const Histogram& steps) {
  return {{"max_ns", steps.max().count()},
          {"median_ns", steps.percentile(0.5).count()},
          {"min_ns", steps.min().count()},
          {"p90_ns", steps.percentile(0.9).count()},
          {"p99_ns", steps.percentile(0.99).count()},
          {"p99_9_ns", steps.percentile(0.999).count()},
          {"steps", steps.count()}};
}

ordered_json json_of(const CorpusTimes& times) {
  ordered_json out = json_of(times.steps);
  out["clock_ns"] = times.clock.count();
  out["over_budget"] = times.steps.over_limit();
  if (const auto* most = times.with_most_stack()) out["stack_bytes"] = *most->stack_bytes;
  out["worst_tick"] = times.with_slowest_step()->slowest_tick();
  return out;
}

ordered_json modules_json(const CorpusTimes& times) {
  ordered_json out = ordered_json::object();
  for (const auto& [module, steps] : times.by_module()) {
    out[std::string(name_of(module))] = json_of(steps);
  }
  return out;
}

// A row for each module, because steps of different modules are not comparable.
std::string table(const CorpusTimes& times) {
  constexpr int title_width = 15;
  std::string out = fmt::format("{:<{}}", "", title_width);
  for (const char* const figure : {"min", "median", "p90", "p99", "p99.9", "max"}) {
    out += fmt::format("{:>10}", figure);
  }
  for (const auto& [module, steps] : times.by_module()) {
    out += fmt::format("\n  {:<{}}", info_of(module).title, title_width - 2);
    for (const Nanoseconds time : {steps.min(), steps.percentile(0.5), steps.percentile(0.9),
                                   steps.percentile(0.99), steps.percentile(0.999), steps.max()}) {
      out += fmt::format("{:>10}", human_time(time));
    }
  }
  return out + "\n";
}

}  // namespace

std::string what_went_wrong(const TimeRun& run) {
  std::string out, last_reason;
  std::size_t repeated = 0;
  const auto say_repeated = [&] {
    if (repeated > 0) out += fmt::format("  and {} more with the same reason\n", repeated);
    repeated = 0;
  };
  for (const VectorTimes& vector : run.times.vectors) {
    const VectorResult& result = vector.result;
    if (!fails_a_run(result.verdict)) continue;
    if (result.reason == last_reason) {
      ++repeated;
      continue;
    }
    say_repeated();
    last_reason = result.reason;
    out += fmt::format("{} {}: {}\n", one_line(result.id()), name_of(result.verdict),
                       one_line(result.reason));
  }
  say_repeated();
  return out;
}

std::string render_times(const TimeRun& run) {
  const CorpusTimes& times = run.times;
  const Histogram& steps = times.steps;
  std::string out = fmt::format(
      "{}: {} steps of {}, each the shortest of {}; the time to read the clock ({}) is "
      "subtracted\n",
      one_line(run.port), steps.count(), counted(timed(times).size(), "vector"),
      counted(static_cast<std::size_t>(run.repeats), "run"), human_time(times.clock));
  out += table(times);
  out += "slowest steps:\n" + slowest(times) + stack(times) + instructions(run.instructions);
  out += what_went_wrong(run);
  if (run.budget_us) {
    out += fmt::format("{} of {} steps took longer than {:g} us\n", steps.over_limit(),
                       steps.count(), *run.budget_us);
  }
  return out;
}

std::string time_json(const TimeRun& run) {
  ordered_json out = {{"schema", "attest-time-1"},
                      {"attest_version", version},
                      {"port", run.port},
                      {"repeats", run.repeats},
                      {"budget_us", nullptr},
                      {"all", json_of(run.times)},
                      {"modules", modules_json(run.times)},
                      {"slowest", run.times.with_slowest_step()->result.id()},
                      {"instructions", run.instructions},
                      {"vectors", ordered_json::array()}};
  if (run.budget_us) out["budget_us"] = *run.budget_us;
  for (const VectorTimes& vector : run.times.vectors) out["vectors"].push_back(json_of(vector));
  return document_of(out);
}

}  // namespace attest
