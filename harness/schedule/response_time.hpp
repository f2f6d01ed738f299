// The longest response of a task under preemptive fixed-priority scheduling, computed instead of
// simulated (M. Joseph and P. Pandya, Finding Response Times in a Real-Time System, 1986).
#pragma once

#include <optional>
#include <vector>

#include "harness/schedule/fixed_priority.hpp"

namespace attest {

// The smallest R with R = C + sum over the tasks of higher priority on its CPU of ceil(R / T) C,
// whatever their phases; empty when R is longer than the task's period, where the next job is
// released before this one is over and the formula does not hold. Executions are the worst.
std::optional<Nanoseconds> response_time(const std::vector<ScheduledTask>& tasks, std::size_t task);

}  // namespace attest
