// The times of a flight's loop, as its case schedules them.
#pragma once

#include "harness/casefile/case.hpp"
#include "harness/schedule/loop_timing.hpp"

namespace attest {

// Of the unit's ticks, the estimator's samples for them and the motor commands that they make.
// REQUIRES: a flight.
LoopTiming case_timing(const Case& the_case, const Rate& rate);

}  // namespace attest
