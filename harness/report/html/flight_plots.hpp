// The plots and the animation of flights, for their page.
#pragma once

#include <string>
#include <vector>

#include "harness/loop/flight.hpp"
#include "harness/report/html/plot_page.hpp"

namespace attest {

// REQUIRES: a flight with at least one tick of each unit.
struct NamedFlight {
  std::string name;  // of the plant; may be empty if it is the only flight
  const Flown* flown;
};

// Attitude, body rates, controls, integrals, motors, saturation and position over the time since
// the first tick. The signals of all flights are in the same plots, with the names of their columns
// in the trace; setpoints are those of the first flight. REQUIRES: at least one flight.
PlotGroup flight_plots(const std::vector<NamedFlight>& flights);

// At most 2000 evenly spaced ticks of each flight.
std::vector<ReplayVehicle> replay_of(const std::vector<NamedFlight>& flights);

}  // namespace attest
