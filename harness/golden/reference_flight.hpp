// What the reference makes of a flight, for its golden.
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
  Trace rows;                             // keyframes
  double horizon_s = 0;                   // how long two right controllers stay together
  std::map<std::string, double> metrics;  // by name
};

// Flies the reference in float32, and once more in double to see when the two part: the horizon is
// the time of the first tick at which an output differs by more than a tenth of its tolerance.
// Errors, with the case's file: the flight cannot be set up; the reference loses the vehicle, or
// misses a bound of the case's own metrics.
Result<ReferenceFlight> reference_flight(const Case& the_case,
                                         const RunConfiguration& configuration,
                                         const VehicleModel& vehicle_model);

// The same at times that are not the case's, for which there is no golden: every row, and metrics
// whatever they are, as the case's bounds were not made for such times. Errors: the flight cannot
// be set up; the reference loses the vehicle.
Result<ReferenceFlight> reference_flight(const Case& the_case,
                                         const RunConfiguration& configuration,
                                         const VehicleModel& vehicle_model,
                                         const LoopTiming& timing);

}  // namespace attest
