// Tasks on one or two CPUs under preemptive fixed-priority scheduling, simulated exactly: what a
// loop feels of the tasks beside it on a flight controller.
//
// Each task stays on its CPU. Of the jobs that are ready on a CPU the one of the highest priority
// runs, and is preempted at once by one of a higher; switching costs nothing (give it to the
// execution times). Jobs of one task run in the order of their releases, each of them: a release
// while one waits or runs waits too.
//
// A task is released at phase + k / rate, or by another: at the instant at which job k of that task
// finishes, job k of this one is released. What is ready at that instant competes by priority.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/schedule/rate.hpp"

namespace attest {

struct ScheduledTask {
  std::string name;
  Rate rate = Rate::hz(1);
  Nanoseconds phase{0};                // of the first release
  std::vector<Nanoseconds> execution;  // of its jobs by turns; not empty, positive
  int priority = 0;                    // higher runs first; no two alike on a CPU
  int cpu = 0;
  // Index of the task that releases it, if not its rate, which is then that task's. At most one
  // task of a set is released so, and not the one that releases.
  std::optional<std::size_t> released_by = std::nullopt;

  Nanoseconds worst_execution() const;
};

// As of the begin of the simulation.
struct TaskJob {
  Nanoseconds release{0};
  Nanoseconds start{0};  // it first ran
  Nanoseconds finish{0};

  Nanoseconds response() const { return finish - release; }
};

// The jobs of each task that are released in [0, duration), in the order of `tasks`, each to its
// end. Errors: two tasks of one priority on a CPU; a CPU that is asked for more than it has, on
// which ever more work would wait.
Result<std::vector<std::vector<TaskJob>>> simulate(const std::vector<ScheduledTask>& tasks,
                                                   Nanoseconds duration);

// The part of its CPU that a set asks for, with its worst executions: 1 is all of it.
double utilisation(const std::vector<ScheduledTask>& tasks, int cpu);

}  // namespace attest
