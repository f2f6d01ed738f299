// What a loop feels of a schedule.
#pragma once

#include <vector>

#include "harness/schedule/fixed_priority.hpp"
#include "harness/schedule/loop_timing.hpp"

namespace attest {

// A tick is a job of the unit: its timestamp is when it first runs, and the motors follow it when
// it is over. It is told the sample that the estimator began its last finished job with; without
// an estimator, that of the moment.
LoopTiming scheduled_timing(const std::vector<TaskJob>& unit,
                            const std::vector<TaskJob>* estimator);

}  // namespace attest
