// The page of `attest sim --html`: one flight with its metrics, plots and a replay of the attitude.
#pragma once

#include <string>

#include "harness/host/port_says.hpp"
#include "harness/measure/simulate.hpp"

namespace attest {

// As html_report(): one file without network, text of the port is escaped. Without a tick the page
// has no plots.
std::string flight_page(const SimulatedFlight& flight, const PortSays& port);

}  // namespace attest
