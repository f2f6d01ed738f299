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

std::string spread(std::string_view name, std::vector<Nanoseconds> times) {
  if (times.empty()) return "";
  std::sort(times.begin(), times.end());
  return fmt::format("  {:<32}{:>10}{:>10}{:>10}\n", name, human_time(times.front()),
                     human_time(times[times.size() / 2]), human_time(times.back()));
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
  return fmt::format("{:<34}{:>10}{:>10}{:>10}\n", fmt::format("delays of the {}", unit), "least",
                     "median", "most") +
         spread("start after the release", begins) +
         spread(fmt::format("{} after the release", result), results) +
         spread(fmt::format("sample age at the {}", result), ages);
}

}  // namespace

std::string render_tasks(const TaskSet& set, const std::vector<std::vector<TaskJob>>& jobs) {
  std::string out = fmt::format("{:<16}{:>4}{:>10}{:>10}{:>12}{:>14}{:>14}\n", "task", "CPU",
                                "priority", "rate", "execution", "response:", "");
  out += fmt::format("{:<52}{:>14}{:>14}\n", "", "analysed", "simulated");
  for (std::size_t i = 0; i < set.tasks.size(); ++i) {
    const ScheduledTask& task = set.tasks[i];
    Nanoseconds longest{0};
    for (const TaskJob& job : jobs[i]) longest = std::max(longest, job.response());
    const auto analysed = response_time(set.tasks, i);
    out += fmt::format("{:<16}{:>4}{:>10}{:>10}{:>12}{:>14}{:>14}{}\n", one_line(task.name),
                       task.cpu, task.priority, task.rate.to_string() + " Hz",
                       human_time(task.worst_execution()),
                       analysed ? human_time(*analysed) : "over a period", human_time(longest),
                       longest > task.rate.tick(1) ? "  longer than its period" : "");
  }
  return out;
}

std::string render_delays(const TaskSet& set, const std::vector<std::vector<TaskJob>>& jobs,
                          const FlightTiming& timing) {
  if (!set.attitude_unit) return delays("loop", "command", jobs[set.unit], timing.unit);
  return delays("rate unit", "command", jobs[set.unit], timing.unit) +
         delays("attitude unit", "setpoint", jobs[*set.attitude_unit], timing.attitude_unit);
}

std::string render_flights(const VectorResult& in_time, const VectorResult& scheduled) {
  std::string out = fmt::format("{:<44}{:>12}{:>12}\n", in_time.case_id(), "in time", "scheduled");
  for (std::size_t i = 0; i < in_time.metrics.size() && i < scheduled.metrics.size(); ++i) {
    const MetricResult& metric = in_time.metrics[i];
    out +=
        fmt::format("  {:<18}{:<24}{:>12.4g}{:>12.4g}  {}\n", metric.name, name_of(metric.measure),
                    metric.value, scheduled.metrics[i].value, metric_bounds(metric));
  }
  for (const auto& [when, result] :
       {std::pair("in time", &in_time), std::pair("scheduled", &scheduled)}) {
    if (result->verdict == Verdict::pass) continue;
    out += fmt::format("  {}: {}: {}\n{}", when, name_of(result->verdict), reason_text(*result),
                       finding_text(*result, Level::numeric));
  }
  return out;
}

}  // namespace attest
