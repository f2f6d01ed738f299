// The times of a loop that result from a schedule of tasks.
#pragma once

#include <vector>

#include "harness/core/fixed_priority.hpp"
#include "harness/core/loop_timing.hpp"

namespace attest {

// Each tick is a job of the unit. Its timestamp is the start of the job; the motors follow its
// command when the job finishes. Its sample is taken at the start of the last estimator job that
// has finished when the tick starts. Before any has finished, `sampled` is negative: there is no
// sample. If `estimator` is null, the sample is taken at the start of the tick.
LoopTiming scheduled_timing(const std::vector<TaskJob>& unit,
                            const std::vector<TaskJob>* estimator);

// The same for the cascade. The attitude unit receives the estimator's samples. Its setpoint
// arrives at the rate unit when its job finishes. The rate unit reads the gyro at the start of its
// job.
FlightTiming scheduled_cascade(const std::vector<TaskJob>& rate_unit,
                               const std::vector<TaskJob>& attitude_unit,
                               const std::vector<TaskJob>* estimator);

}  // namespace attest
