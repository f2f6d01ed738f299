// One case in, one flown trace out.
#pragma once

#include <memory>
#include <optional>

#include "harness/casefile/case.hpp"
#include "harness/core/result.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/plant/plant.hpp"
#include "harness/port/port.hpp"
#include "harness/schedule/loop_timing.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

struct Flown {
  Trace trace;                           // every tick up to the end, with Trace::plant
  std::optional<PortFault> fault;        // of the port: the ticks before it are valid
  std::optional<Divergence> divergence;  // early end; its time counts from the first tick
};

// The case bound to this vehicle: parameters that the case does not set get the vehicle's values.
// Thrusts in units of hover thrust are scaled by the vehicle's hover thrust.
Case bound_to_vehicle(const Case& the_case, const Vehicle& vehicle);

// How often MuJoCo steps. REQUIRES: a flight.
Rate physics_of(const Case& the_case, const Rate& loop);

// The plant of a configuration. REQUIRES: the case is a flight. Errors: those of fly().
Result<std::unique_ptr<Plant>> plant_for(const Case& the_case,
                                         const RunConfiguration& configuration,
                                         const VehicleModel& vehicle_model);

// Flies `the_case` with a fresh `unit`, at the times that the case schedules, or at those of
// `timing`. REQUIRES: the case is a flight. Errors, with the case's file: physics slower than the
// loop, a rotor that the vehicle does not have.
Result<Flown> fly(const Case& the_case, const RunConfiguration& configuration,
                  const VehicleModel& vehicle_model, Unit& unit);
Result<Flown> fly(const Case& the_case, const RunConfiguration& configuration,
                  const VehicleModel& vehicle_model, Unit& unit, LoopTiming timing);

}  // namespace attest
