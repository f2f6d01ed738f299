// The flight of the reference, for the golden of a case.
#pragma once

#include <map>
#include <string>

#include "harness/casefile/case.hpp"
#include "harness/core/loop_timing.hpp"
#include "harness/core/result.hpp"
#include "harness/plant/plant.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

struct ReferenceFlight {
  Trace rows;            // some ticks or all, with timestamps, of the unit that commands the motors
  double horizon_s = 0;  // how long two correct controllers agree
  std::map<std::string, double> metrics;  // by name
};

// Flies the reference in float32 and again in double. The horizon is the time of the first tick at
// which an output of these two flights differs by more than a tenth of its tolerance, or the end of
// the flight. Errors, with the case's file: the flight cannot be set up; the reference loses the
// vehicle, or misses a bound of the case's metrics.
Result<ReferenceFlight> reference_flight(const Case& the_case,
                                         const RunConfiguration& configuration,
                                         const VehicleModel& vehicle_model);

// The same with `timing` instead of the case's times. The metrics are measured but not checked,
// because the case's bounds are not for other times. Errors: the flight cannot be set up; the
// reference loses the vehicle.
Result<ReferenceFlight> reference_flight(const Case& the_case,
                                         const RunConfiguration& configuration,
                                         const VehicleModel& vehicle_model,
                                         const FlightTiming& timing);

}  // namespace attest
