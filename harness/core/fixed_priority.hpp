// Simulates tasks on CPUs exactly, under preemptive fixed-priority scheduling. The simulation shows
// how the other tasks of a flight controller delay a loop.
//
// Each task stays on its CPU. Of the jobs that are ready on a CPU the one with the highest priority
// runs. A job of higher priority preempts it at once. Switching takes no time; add its cost to the
// execution times. Jobs of one task run in the order of their releases. Every release makes a job;
// if an earlier job of the task has not finished, the new job waits for it.
//
// A task is released at phase + k / rate, or by another task: when job k of the releasing task
// finishes, job k of the released task is released. All jobs that are ready at that instant compete
// by priority.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harness/core/rate.hpp"
#include "harness/core/result.hpp"

namespace attest {

struct ScheduledTask {
  std::string name;
  Rate rate = Rate::hz(1);
  Nanoseconds phase{0};                // of the first release
  std::vector<Nanoseconds> execution;  // job k uses element k modulo size; not empty, positive
  int priority = 0;                    // higher runs first; unique on a CPU
  int cpu = 0;
  // Index of the task that releases this one; empty if its rate does. REQUIRES: `rate` is that of
  // the releasing task; at most one task of a set has a releasing task; no task releases itself.
  std::optional<std::size_t> released_by = std::nullopt;

  Nanoseconds worst_execution() const;
};

// Times since the start of the simulation.
struct TaskJob {
  Nanoseconds release{0};
  Nanoseconds start{0};  // when it first ran
  Nanoseconds finish{0};

  Nanoseconds response() const { return finish - release; }
};

// The jobs of each task that are released in [0, duration), in the order of `tasks`. Each job is
// simulated to its end. Errors: two tasks of one priority on a CPU; a CPU with a utilisation above
// 1, on which more and more work would wait.
Result<std::vector<std::vector<TaskJob>>> simulate(const std::vector<ScheduledTask>& tasks,
                                                   Nanoseconds duration);

// The utilisation of a CPU by its tasks with their worst execution times; 1 is the whole CPU.
double utilisation(const std::vector<ScheduledTask>& tasks, int cpu);

}  // namespace attest
