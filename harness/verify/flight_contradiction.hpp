// Checks that the traces of a flight are those of the flight that was asked for. The port runs in
// the process that reports the traces, so it could replace the inputs by others that suit its
// outputs.
#pragma once

#include <string>

#include "harness/host/port_host.hpp"
#include "harness/loop/flight.hpp"

namespace attest {

// The first contradiction between the traces and the plan, or between the traces of both units, as
// one line; empty if there is none. These must agree to the bit:
//
// - the number of ticks with that of the plan; a flight that ended early may have fewer
// - each timestamp with the plan
// - the scripted topics, their updated bits and the parameters with the case
// - the rate unit's vehicle_rates_setpoint with the attitude unit's outputs that have arrived,
//   unless the case scripts this topic, too
//
// The reaction of the plant to the outputs is not checked: the golden and the metrics judge it.
// REQUIRES: `course` and `plan` are those of the flight.
std::string flight_contradiction(const Course& course, const FlightPlan& plan, const Flown& flown);

}  // namespace attest
