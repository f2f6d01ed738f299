// The file that describes the tasks of a flight controller (SCHEMA.md): the unit's task, the other
// tasks, and their execution times.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/schedule/fixed_priority.hpp"

namespace attest {

struct TaskSet {
  std::vector<ScheduledTask> tasks;
  std::size_t unit = 0;                  // index of the task `unit`
  std::optional<std::size_t> estimator;  // index of the task `estimator`, if there is one
};

// Errors, with file and line: no task `unit`; values out of range.
Result<TaskSet> read_task_set(const std::filesystem::path& path);

}  // namespace attest
