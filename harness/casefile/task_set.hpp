// The file that describes the tasks of a flight controller (SCHEMA.md): the units' tasks, the other
// tasks, and their execution times.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "harness/core/fixed_priority.hpp"
#include "harness/core/loop_rate.hpp"
#include "harness/core/result.hpp"
#include "harness/trace/module.hpp"

namespace attest {

struct TaskSet {
  std::vector<ScheduledTask> tasks;
  std::size_t unit = 0;                  // index of the task `unit`
  std::optional<std::size_t> estimator;  // index of the task `estimator`, if there is one
  // Index of the task `attitude_unit`, if there is one: `unit` is then the cascade's rate unit.
  std::optional<std::size_t> attitude_unit;

  LoopRate rate() const {
    const Rate& own = tasks[unit].rate;
    return attitude_unit ? LoopRate(tasks[*attitude_unit].rate, own) : LoopRate(own);
  }
};

// The execution times of the units' jobs, where they were measured.
using UnitExecution = std::map<Module, Nanoseconds>;

// With `measured`, the tasks of the units take their execution times from it, and need none in the
// file: `unit` is the controller, or the rate unit if there is a task `attitude_unit`.
//
// Errors, with the file and, if known, the line: syntax, unknown keys, values out of range; no task
// `unit`; a `trigger` where SCHEMA.md does not allow it; a rate unit slower than its attitude unit;
// `measured` lacks a unit.
Result<TaskSet> read_task_set(const std::filesystem::path& path,
                              const std::optional<UnitExecution>& measured = {});

}  // namespace attest
