// The steps of a log that can be judged alone.
//
// The default log of PX4 has one step of 5 to 20, so what depends on earlier steps cannot be
// computed from it. But for some steps it has all that the law itself needs. They are:
//
// - Steps of the attitude unit whose rates setpoint is in the log. If the unit makes its attitude
//   setpoint from the sticks, the log must have this setpoint, too: it becomes an input.
// - Steps of the rate unit whose torque, thrust and integral are in the log. In the inputs, the
//   vehicle is neither armed nor in the air, so that the integral of the unit is 0 in each step. To
//   compare the torques, subtract the integral from the logged one.
//
// The log does not have every setpoint, so the last one before a step may not be the one in use. A
// unit copies the thrust of its setpoint to its output: if the two differ in a bit, another
// setpoint was in use, and the step is left out. If the thrust rarely changes, an old setpoint can
// still have the same. So the age of the setpoint (LoggedSetpoint::time_us) must be considered,
// too.
#pragma once

#include "harness/core/result.hpp"
#include "harness/ulog/flight_log.hpp"

namespace attest {

// The steps of `log`, a unit of v1.14 to v1.18 with ticks: a unit whose ticks are these steps, with
// LoggedUnit::single_steps. Reads the ticks once. REQUIRES: `log` outlives it. Errors: those of
// LoggedTicks::next_part().
Result<LoggedUnit> single_steps_of(const LoggedUnit& log);

}  // namespace attest
