#include "harness/casefile/task_set.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "harness/core/suggestion.hpp"
#include "harness/core/toml.hpp"

namespace attest {
namespace {

Nanoseconds micros(double us) { return Nanoseconds(std::llround(us * 1000)); }

constexpr Nanoseconds least_execution = std::chrono::microseconds(1);

// One number, or several that successive jobs use in turn. At least 1 us, because timestamps are
// in microseconds and each job of the unit needs its own.
std::vector<Nanoseconds> parse_execution(const TomlTable& table) {
  constexpr const char* key = "execution_us";
  std::vector<double> numbers;
  if (table.kind(key) == TomlKind::array) {
    numbers = table.numbers(key);
  } else {
    numbers.push_back(table.number(key));
  }
  std::vector<Nanoseconds> execution;
  for (const double us : numbers) {
    if (table.has(key) && !(us >= 1 && us <= 1e9)) table.error(key, "must be from 1 to 1e9");
    execution.push_back(micros(us));
  }
  if (numbers.empty()) table.error(key, "is empty");
  return execution;
}

void parse_release(const TomlTable& table, ScheduledTask& task) {
  const auto rate = Rate::parse(fmt::format("{}", table.number("rate_hz")));
  if (!rate && table.has("rate_hz")) table.error("rate_hz", rate.error().message);
  if (rate) task.rate = *rate;
  const double phase_us = table.number("phase_us", 0);
  if (!(phase_us >= 0 && phase_us <= 1e9)) table.error("phase_us", "must be from 0 to 1e9");
  task.phase = micros(phase_us);
}

constexpr std::int64_t most_priority = 1'000'000;

// `measured`: the execution time, in place of that of the file.
ScheduledTask parse_task(const TomlTable& table, const std::string& name,
                         std::optional<Nanoseconds> measured) {
  ScheduledTask task;
  task.name = name;
  if (!table.has("trigger")) parse_release(table, task);
  if (!measured || table.has("execution_us")) task.execution = parse_execution(table);
  if (measured) task.execution = {std::max(*measured, least_execution)};
  const std::int64_t priority = table.integer("priority");
  if (priority < -most_priority || priority > most_priority) {
    table.error("priority", fmt::format("must be from {} to {}", -most_priority, most_priority));
  } else {
    task.priority = static_cast<int>(priority);
  }
  const std::int64_t cpu = table.integer("cpu", 0);
  if (cpu != 0 && cpu != 1) table.error("cpu", "must be 0 or 1");
  task.cpu = cpu == 1 ? 1 : 0;
  return task;
}

std::optional<std::size_t> find_task(const std::vector<ScheduledTask>& tasks,
                                     const std::string& name) {
  const auto found = std::find_if(tasks.begin(), tasks.end(),
                                  [&](const ScheduledTask& task) { return task.name == name; });
  if (found == tasks.end()) return std::nullopt;
  return static_cast<std::size_t>(found - tasks.begin());
}

// Reads `trigger = "estimator"`: it replaces the rate of the unit that receives the estimate.
void parse_trigger(const TomlTable& table, const std::string& name, TaskSet& set) {
  constexpr const char* key = "trigger";
  if (!table.has(key)) return;
  const bool is_attitude_unit = name == "attitude_unit";
  if (name != "unit" && !is_attitude_unit) {
    return table.error(key, "is for [task.unit] and [task.attitude_unit]; give `rate_hz`");
  }
  if (!is_attitude_unit && set.attitude_unit) {
    return table.error(key, "the rate unit reads the gyro at its own rate: give `rate_hz`");
  }
  for (const char* const other : {"rate_hz", "phase_us"}) {
    if (table.has(other)) table.error(other, "`trigger` is given too; keep one");
  }
  if (table.text(key) != "estimator") return table.error(key, "must be \"estimator\"");
  if (!set.estimator) return table.error(key, "needs [task.estimator]");
  ScheduledTask& unit = set.tasks[is_attitude_unit ? *set.attitude_unit : set.unit];
  unit.released_by = set.estimator;
  unit.rate = set.tasks[*set.estimator].rate;
}

// A task may have any name, but `unit`, `estimator` and `attitude_unit` have a meaning. If `meant`
// is missing, a name that is nearly the same is reported as a misspelling of it; then this returns
// true.
bool is_misspelt(const TomlTable& tasks, const std::string& meant) {
  const std::vector<std::string> names = tasks.keys();
  if (std::find(names.begin(), names.end(), meant) != names.end()) return false;
  bool misspelt = false;
  for (const std::string& name : names) {
    const std::string said = suggestion(name, {meant});
    if (said.empty()) continue;
    tasks.error(name, fmt::format("there is no [task.{}]{}", meant, said));
    misspelt = true;
  }
  return misspelt;
}

// The measured execution time of the task `name`; empty if it is no unit.
std::optional<Nanoseconds> measured_of(const UnitExecution& measured, const std::string& name,
                                       const TomlTable& tasks) {
  const bool is_cascade = tasks.has("attitude_unit");
  Module module = is_cascade ? Module::rate_unit : Module::mc_att_control;
  if (name == "attitude_unit") module = Module::attitude_unit;
  if (name != "unit" && name != "attitude_unit") return std::nullopt;
  if (const auto found = measured.find(module); found != measured.end()) return found->second;
  tasks.error(name, fmt::format("no execution time of the {} was measured", info_of(module).title));
  return std::nullopt;
}

}  // namespace

Result<TaskSet> read_task_set(const std::filesystem::path& path,
                              const std::optional<UnitExecution>& measured) {
  const auto file = TomlFile::read(path);
  if (!file) return tl::unexpected(file.error());
  const TomlTable root = file->root();
  const TomlTable tasks = root.table("task");
  TaskSet set;
  for (const std::string& name : tasks.keys()) {
    const auto execution = measured ? measured_of(*measured, name, tasks) : std::nullopt;
    set.tasks.push_back(parse_task(tasks.table(name), name, execution));
  }
  is_misspelt(tasks, "estimator");
  is_misspelt(tasks, "attitude_unit");
  const bool unit_misspelt = is_misspelt(tasks, "unit");
  const auto unit = find_task(set.tasks, "unit");
  if (!unit && !unit_misspelt && root.has("task")) {
    root.error("task", "needs [task.unit], the controller");
  }
  set.unit = unit.value_or(0);
  set.estimator = find_task(set.tasks, "estimator");
  set.attitude_unit = find_task(set.tasks, "attitude_unit");
  for (const std::string& name : tasks.keys()) parse_trigger(tasks.table(name), name, set);
  if (auto done = file->finish(); !done) return tl::unexpected(done.error());
  if (set.attitude_unit && set.estimator && !set.tasks[*set.attitude_unit].released_by) {
    return fail_at(path.string(),
                   "[task.attitude_unit] needs `trigger = \"estimator\"`: it is stepped once for "
                   "each sample of [task.estimator]",
                   root.line("task"));
  }
  if (set.attitude_unit && set.tasks[set.unit].rate < set.tasks[*set.attitude_unit].rate) {
    return fail_at(path.string(), "[task.unit], the rate unit, is slower than [task.attitude_unit]",
                   root.line("task"));
  }
  return set;
}

}  // namespace attest
