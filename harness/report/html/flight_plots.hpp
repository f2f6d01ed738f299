// The plots and the animation of flights, for their page.
#pragma once

#include <string>
#include <vector>

#include "harness/loop/flight.hpp"
#include "harness/report/document.hpp"

namespace attest {

// REQUIRES: a flight with at least one tick of each unit.
struct NamedFlight {
  std::string name;  // the name of the plant; may be empty for a single flight
  const Flown* flown;
};

// Attitude, body rates, controls, integrals, motors, saturation and position over the time since
// the first tick. The signals of all flights are in the same plots. Lines are named after the
// columns of the trace, or roll, pitch and yaw. Setpoints are those of the first flight. REQUIRES:
// at least one flight.
PlotGroup flight_plots(const std::vector<NamedFlight>& flights);

// For the animation: at most 2000 evenly spaced ticks of each flight.
std::vector<ReplayVehicle> replay_of(const std::vector<NamedFlight>& flights);

}  // namespace attest
