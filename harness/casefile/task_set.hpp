// The tasks of a flight controller as a file (SCHEMA.md): what runs beside the unit, and for how
// long.
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
  std::optional<std::size_t> estimator;  // and of `estimator`, if there is one
};

// Errors, with file and line: no task `unit`, values that make no sense.
Result<TaskSet> read_task_set(const std::filesystem::path& path);

}  // namespace attest
