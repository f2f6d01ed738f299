// The times of a flight's loop, as its case schedules them.
#pragma once

#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/schedule/loop_timing.hpp"

namespace attest {

// Of the unit's ticks, the estimator's samples for them and the motor commands that they make.
//
//     begins = the unit's tick; sampled = begins - delay, or the estimator's last by then
//     trigger = "estimator": sampled = the estimator's tick; begins = sampled + delay
//
// In both, commanded = begins + actuator delay. REQUIRES: a flight.
LoopTiming case_timing(const Case& the_case, const Rate& rate);

// When a task beside the unit's runs.
std::vector<Nanoseconds> task_times(const TaskTiming& timing, const Timeline& timeline);

}  // namespace attest
