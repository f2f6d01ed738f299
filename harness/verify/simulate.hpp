// Flies one simulated flight.
#pragma once

#include "harness/casefile/case.hpp"
#include "harness/host/port_host.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

struct SimulatedFlight {
  VectorResult result;
  Flown flown;  // no ticks if the port has a fault or does not fly; else all ticks up to the end
};

// Flies a fresh unit. Judges a fault, the loss of the vehicle, and the metrics by the case's own
// bounds only. Outputs are not judged. REQUIRES: the host's course is this case. Errors: the flight
// cannot be set up.
Result<SimulatedFlight> simulate_flight(const Case& the_case, FlightPlan plan, PortHost& host);

// Notes the first output that deviates from the reference's for the same inputs, and the worst one,
// in the result. The verdict stays.
Result<void> note_deviations(const Case& the_case, const Declarations& port,
                             SimulatedFlight& flight);

}  // namespace attest
