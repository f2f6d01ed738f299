// The plots and the replay of flights, for their page.
#pragma once

#include <string>
#include <vector>

#include "harness/report/html/plot_page.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// REQUIRES: a flown trace with at least one tick.
struct NamedFlight {
  std::string name;  // of the plant; may be empty if it is the only flight
  const Trace* flown;
};

// Attitude, body rates, controls, integrals, motors, saturation and position over the time since
// the first tick. The signals of all flights are in the same plots, with the names of their columns
// in the trace; setpoints are those of the first flight. REQUIRES: at least one flight.
PlotGroup flight_plots(const std::vector<NamedFlight>& flights);

// At most 2000 evenly spaced ticks of each flight.
std::vector<ReplayVehicle> replay_of(const std::vector<NamedFlight>& flights);

}  // namespace attest
