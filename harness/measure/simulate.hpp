// One flight at the desk, written down.
#pragma once

#include <filesystem>

#include "harness/casefile/case.hpp"
#include "harness/host/port_host.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// Flies a fresh unit and writes the flown trace to `out`, also of a flight that ends early; `out`
// is not touched when the port goes wrong. The metrics have no reference here but the case's own
// bounds. REQUIRES: the host's course is this case. Errors: the flight cannot be set up, or
// written.
Result<CaseResult> simulate_flight(const Case& the_case, FlightPlan plan, PortHost& host,
                                   const std::filesystem::path& out);

}  // namespace attest
