// One simulated flight.
#pragma once

#include "harness/casefile/case.hpp"
#include "harness/host/port_host.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

struct SimulatedFlight {
  CaseResult result;
  Flown flown;  // also of a flight that ends early; without ticks after a fault of the port
};

// Flies a fresh unit. The metrics are judged by the case's own bounds only. REQUIRES: the host's
// course is this case. Errors: the flight cannot be set up.
Result<SimulatedFlight> simulate_flight(const Case& the_case, FlightPlan plan, PortHost& host);

}  // namespace attest
