// The times of a loop that result from a schedule of tasks.
#pragma once

#include <vector>

#include "harness/schedule/fixed_priority.hpp"
#include "harness/schedule/loop_timing.hpp"

namespace attest {

// Each tick is a job of the unit. Its timestamp is the start of the job; the motors follow its
// command when the job finishes. Its sample is the one with which the estimator's last finished job
// began. Without an estimator, the sample is taken at the start of the tick.
LoopTiming scheduled_timing(const std::vector<TaskJob>& unit,
                            const std::vector<TaskJob>* estimator);

// The same for the cascade. The attitude unit gets the estimator's samples. Its setpoint arrives
// when its job finishes. The rate unit reads the gyro at the start of its job.
FlightTiming scheduled_cascade(const std::vector<TaskJob>& rate_unit,
                               const std::vector<TaskJob>& attitude_unit,
                               const std::vector<TaskJob>* estimator);

}  // namespace attest
