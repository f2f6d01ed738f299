// One simulated flight, written to a file.
#pragma once

#include <filesystem>

#include "harness/casefile/case.hpp"
#include "harness/host/port_host.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// Flies a fresh unit and writes the flown trace to `out`, also of a flight that ends early. After a
// fault of the port `out` is not written. The metrics are judged by the case's own bounds only.
// REQUIRES: the host's course is this case. Errors: the flight cannot be set up, or written.
Result<CaseResult> simulate_flight(const Case& the_case, FlightPlan plan, PortHost& host,
                                   const std::filesystem::path& out);

}  // namespace attest
