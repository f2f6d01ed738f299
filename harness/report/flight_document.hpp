// The report of `attest sim`: a flight with its metrics, plots and its animated attitude.
#pragma once

#include <vector>

#include "harness/host/declarations.hpp"
#include "harness/report/document.hpp"
#include "harness/verify/simulate.hpp"

namespace attest {

// Plots attitude, body rates, controls, integrals, motors, saturation and position over the time
// since the first tick. Several flights must be those of one case on several plants. They are in
// the same plots, with the names of the plants. A flight without a tick has no plots. REQUIRES: at
// least one flight.
Document flight_document(const std::vector<SimulatedFlight>& flights, const Declarations& port);

}  // namespace attest
