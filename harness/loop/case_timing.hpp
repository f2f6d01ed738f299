// The times of a flight's loop, as its case schedules them.
#pragma once

#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/core/loop_rate.hpp"
#include "harness/core/loop_timing.hpp"

namespace attest {

// The times of the unit's ticks, of the estimator's samples for them, and of their results: the
// motor commands, or of the attitude unit its setpoint.
//
//     begins = the unit's tick; sampled = begins - delay
//     with drift: sampled = the estimator's last sample at or before begins - delay
//     with trigger = "estimator": sampled = the estimator's tick; begins = sampled + delay
//
// In all three cases, commanded = begins + actuator delay. Of the attitude unit, commanded = begins
// + AttitudeLoop::delay. For the cascade's rate unit sampled = begins: it reads the gyro itself.
// REQUIRES: a flight, and the rate of the unit of the case's module.
LoopTiming case_timing(const Case& the_case, const Rate& rate);

FlightTiming flight_timing(const Case& the_case, const LoopRate& rate);

// The firmware's land detector runs at 50 Hz.
TaskTiming land_detection();

std::vector<Nanoseconds> task_times(const TaskTiming& timing, const Timeline& timeline);

}  // namespace attest
