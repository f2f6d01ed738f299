// The report of `attest sim`: a flight with its metrics, plots and its animated attitude.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/compare/metric.hpp"
#include "harness/host/declarations.hpp"
#include "harness/report/document.hpp"
#include "harness/verify/simulate.hpp"

namespace attest {

// What the plots show in addition to the flights.
struct FlightBackground {
  std::optional<Flown> reference =
      {};  // the reference in the place of the port, on the first plant
  std::vector<PlotMark> marks = {};
  std::vector<Metric> metrics = {};  // of the case; the plots show their bounds
};

// Marks gusts, shifts of the centre of mass, the failure of a motor, the reset of the estimator,
// and the first deviation in the result of the flight.
std::vector<PlotMark> marks_of(const Case& the_case, const SimulatedFlight& flight);

// The plots of a flight, in the order of the page. attitude_error and rate_length are on the page
// if a metric measures them.
enum class FlightPlot {
  attitude,
  attitude_error,
  body_rates,
  rate_length,
  controls,
  thrust,
  integrals,
  motors,
  saturation,
  position,
};

// The plot that shows over time what a measure measures.
FlightPlot plot_of(Measure measure);

// The bounds of the metric as lines in plot_of(its measure). Empty if they do not bound the value
// at a tick: the bounds of a mean or a ratio. REQUIRES: the series of the plot have ticks.
std::vector<PlotBound> lines_of_bounds(const Metric& metric, const Plot& plot);

// Plots attitude, body rates, controls, integrals, motors, saturation and position over the time
// since the first tick. Several flights must be those of one case on several plants. They are in
// the same plots, with the names of the plants. A flight without a tick has no plots. REQUIRES: at
// least one flight.
Document flight_document(const std::vector<SimulatedFlight>& flights, const Declarations& port,
                         const FlightBackground& background = {});

// "PASS the metrics are within their bounds; the outputs agree ...", or "DIFFERS ..." if only the
// metrics pass. It names the flight whose verdict the document has. `is_reference`: the reference
// flew, so there was no other flight to compare with. REQUIRES: a flight has that verdict.
std::string flight_conclusion(const std::vector<SimulatedFlight>& flights, const Document& document,
                              bool is_reference);

}  // namespace attest
