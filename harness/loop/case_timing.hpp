// The times of a flight's loop, as its case schedules them.
#pragma once

#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/schedule/loop_rate.hpp"
#include "harness/schedule/loop_timing.hpp"

namespace attest {

// The times of the unit's ticks, of the estimator's samples for them, and of the motor commands
// that follow from them.
//
//     begins = the unit's tick; sampled = begins - delay
//     drift: sampled = the estimator's last sample at or before begins - delay
//     trigger = "estimator": sampled = the estimator's tick; begins = sampled + delay
//
// In all three, commanded = begins + actuator delay. Of the cascade, delay and drift are those of
// the attitude unit's samples, and the rate unit reads the gyro when its tick begins. The attitude
// unit's setpoint arrives AttitudeLoop::delay after its tick. REQUIRES: a flight, and the rate of
// the unit of the case's module.
LoopTiming case_timing(const Case& the_case, const Rate& rate);

// The times of all units of a flight.
FlightTiming flight_timing(const Case& the_case, const LoopRate& rate);

// The firmware's land detector runs at 50 Hz.
TaskTiming land_detection();

// The times at which a task other than the unit's runs.
std::vector<Nanoseconds> task_times(const TaskTiming& timing, const Timeline& timeline);

}  // namespace attest
