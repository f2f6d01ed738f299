#include "harness/report/schedule_text.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "harness/core/response_time.hpp"
#include "harness/report/document.hpp"
#include "harness/report/failure_text.hpp"
#include "harness/report/text.hpp"

namespace attest {
namespace {

void add_spread(const std::string& name, std::vector<Nanoseconds> times, DocumentTable& table) {
  if (times.empty()) return;
  std::sort(times.begin(), times.end());
  table.rows.push_back({name, times.front(), times[times.size() / 2], times.back()});
}

// `result`: the name of the output of a job, "command".
std::string delays(std::string_view unit, std::string_view result, const std::vector<TaskJob>& jobs,
                   const LoopTiming& timing) {
  std::vector<Nanoseconds> begins, results, ages;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    begins.push_back(jobs[i].start - jobs[i].release);
    results.push_back(jobs[i].finish - jobs[i].release);
    if (timing[i].sampled >= Nanoseconds(0)) ages.push_back(jobs[i].finish - timing[i].sampled);
  }
  DocumentTable table{fmt::format("delays of the {}", unit), {"", "least", "median", "most"}};
  add_spread("start after the release", begins, table);
  add_spread(fmt::format("{} after the release", result), results, table);
  add_spread(fmt::format("sample age at the {}", result), ages, table);
  return render_text(table, {});
}

}  // namespace

std::string render_tasks(const TaskSet& set, const std::vector<std::vector<TaskJob>>& jobs) {
  DocumentTable table{
      "",
      {"task", "CPU", "priority", "rate [Hz]", "execution", "response: analysed", "simulated", ""}};
  for (std::size_t i = 0; i < set.tasks.size(); ++i) {
    const ScheduledTask& task = set.tasks[i];
    Nanoseconds longest{0};
    for (const TaskJob& job : jobs[i]) longest = std::max(longest, job.response());
    const auto analysed = response_time(set.tasks, i);
    table.rows.push_back({task.name, fmt::to_string(task.cpu), fmt::to_string(task.priority),
                          task.rate.to_string(), task.worst_execution(),
                          analysed ? Cell(*analysed) : Cell("over a period"), longest,
                          longest > task.rate.tick(1) ? "longer than its period" : ""});
  }
  return render_text(table, {});
}

std::string render_delays(const TaskSet& set, const std::vector<std::vector<TaskJob>>& jobs,
                          const FlightTiming& timing) {
  if (!set.attitude_unit) return delays("loop", "command", jobs[set.unit], timing.unit);
  return delays("rate unit", "command", jobs[set.unit], timing.unit) +
         delays("attitude unit", "setpoint", jobs[*set.attitude_unit], timing.attitude_unit);
}

std::string render_flights(const VectorResult& in_time, const VectorResult& scheduled) {
  DocumentTable table{in_time.case_id(), {"metric", "measure", "in time", "scheduled", "bounds"}};
  for (std::size_t i = 0; i < in_time.metrics.size() && i < scheduled.metrics.size(); ++i) {
    const MetricResult& metric = in_time.metrics[i];
    table.rows.push_back(
        {metric.name, std::string(name_of(metric.measure)), fmt::format("{:.4g}", metric.value),
         fmt::format("{:.4g}", scheduled.metrics[i].value), metric_bounds(metric)});
  }
  std::string out = render_text(table, {});
  for (const auto& [when, result] :
       {std::pair("in time", &in_time), std::pair("scheduled", &scheduled)}) {
    if (result->verdict == Verdict::pass) continue;
    out += fmt::format("  {}: {}: {}\n{}", when, name_of(result->verdict), reason_text(*result),
                       finding_text(*result, Level::numeric));
  }
  return out;
}

}  // namespace attest
