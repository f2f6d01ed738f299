// The flight of the reference, for the golden of a case.
#pragma once

#include <map>
#include <string>

#include "harness/casefile/case.hpp"
#include "harness/core/result.hpp"
#include "harness/plant/plant.hpp"
#include "harness/schedule/loop_timing.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

struct ReferenceFlight {
  Trace rows;                             // keyframes, of the unit that commands the motors
  double horizon_s = 0;                   // how long two correct controllers agree
  std::map<std::string, double> metrics;  // by name
};

// Flies the reference in float32 and again in double. The horizon is the time of the first tick at
// which an output differs by more than a tenth of its tolerance. Errors, with the case's file: the
// flight cannot be set up; the reference loses the vehicle, or misses a bound of the case's own
// metrics.
Result<ReferenceFlight> reference_flight(const Case& the_case,
                                         const RunConfiguration& configuration,
                                         const VehicleModel& vehicle_model);

// The same at other times than the case's. These have no golden, so every row is kept. The metrics
// are not checked, because the case's bounds are not for such times. Errors: the flight cannot be
// set up; the reference loses the vehicle.
Result<ReferenceFlight> reference_flight(const Case& the_case,
                                         const RunConfiguration& configuration,
                                         const VehicleModel& vehicle_model,
                                         const FlightTiming& timing);

}  // namespace attest
