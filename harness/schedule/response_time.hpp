// The longest response of a task under preemptive fixed-priority scheduling, computed instead of
// simulated (M. Joseph and P. Pandya, Finding Response Times in a Real-Time System, 1986).
#pragma once

#include <optional>
#include <vector>

#include "harness/schedule/fixed_priority.hpp"

namespace attest {

// The smallest R with R = C + sum over the tasks of higher priority on its CPU of ceil((R + J) / T)
// C, whatever their phases. Executions are the worst. J is how much later than its rate says a task
// may be released: 0, or for one that another releases that task's R less its shortest execution
// (N. Audsley et al., Applying New Scheduling Theory to Static Priority Pre-emptive Scheduling,
// 1993). What a task releases itself runs at most once in its own R. With a J the R is a bound, and
// else it is met.
//
// Empty when R + J is longer than the task's period, where the next job is released before this one
// is over and the formula does not hold.
std::optional<Nanoseconds> response_time(const std::vector<ScheduledTask>& tasks, std::size_t task);

}  // namespace attest
