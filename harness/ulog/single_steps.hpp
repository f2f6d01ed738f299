// The steps of a log that can be judged one by one.
//
// The default log of PX4 has one step of 5 to 20, so what depends on earlier steps cannot be
// computed from it. But for some steps it has all that the law itself needs. They are:
//
// - Steps of the attitude unit whose rates setpoint is in the log. If the unit makes its attitude
//   setpoint from the sticks, the log must have this setpoint, too: it becomes an input.
// - Steps of the rate unit whose torque, thrust and integral are in the log. The vehicle is not
//   armed in the inputs, so that the integral of the unit is 0 in each step. To compare the
//   torques, subtract the integral from the logged one.
//
// The log does not have every setpoint, so the last one before a step may not be the one in use.
// Two facts tell. A unit copies the thrust of its setpoint to its output: if they differ, another
// setpoint was in use. And if this shows that setpoints up to some age were in use, a setpoint of
// this age is believed to have been in use even if the thrust does not change.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "harness/core/result.hpp"
#include "harness/ulog/flight_log.hpp"

namespace attest {

// The steps of `log`, a unit of v1.14 to v1.18 with ticks: a unit whose ticks are these steps, with
// LoggedUnit::single_steps. Reads the ticks two or three times. REQUIRES: `log` outlives it.
// Errors: those of LoggedTicks::next_part().
Result<LoggedUnit> single_steps_of(const LoggedUnit& log);

}  // namespace attest
