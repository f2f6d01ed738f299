// The longest response time of a task under preemptive fixed-priority scheduling, computed instead
// of simulated (M. Joseph and P. Pandya, Finding Response Times in a Real-Time System, 1986).
#pragma once

#include <optional>
#include <vector>

#include "harness/core/fixed_priority.hpp"

namespace attest {

// The bound R of the response time of a task, for any phases: the smallest R with
//
//     R = C + sum over k of ceil((R + J_k) / T_k) C_k
//
// where k are the tasks of higher priority on the same CPU, C is the worst execution time, and T
// the period. J is the release jitter of a task: 0 if its rate releases it. If another task
// releases it, J is the releasing task's R minus its shortest execution time (N. Audsley et al.,
// Applying New Scheduling Theory to Static Priority Pre-emptive Scheduling, 1993). A task k that
// `task` itself releases counts once. Without jitter, R is reached for some phases; with jitter, R
// is an upper bound.
//
// Empty if R + J of the task is longer than its period: then the next job is released before this
// one ends, and the formula does not hold. Also empty if J or a J_k needs the R of a releasing task
// for which the result is empty.
std::optional<Nanoseconds> response_time(const std::vector<ScheduledTask>& tasks, std::size_t task);

}  // namespace attest
