// The page of `attest sim --html`: a flight with its metrics, plots and its animated attitude.
#pragma once

#include <string>
#include <vector>

#include "harness/host/declarations.hpp"
#include "harness/verify/simulate.hpp"

namespace attest {

// Several flights must be those of one case on several plants. They are in the same plots, with the
// names of the plants. A flight without a tick has no plots. REQUIRES: at least one flight.
std::string flight_page(const std::vector<SimulatedFlight>& flights, const Declarations& port);

}  // namespace attest
