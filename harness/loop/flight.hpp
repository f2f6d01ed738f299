// One case in, one flown trace out.
#pragma once

#include <memory>
#include <optional>

#include "harness/casefile/case.hpp"
#include "harness/core/result.hpp"
#include "harness/loop/closed_loop.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/plant/plant.hpp"
#include "harness/port/port.hpp"
#include "harness/schedule/loop_timing.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

struct Flown {
  // Every tick up to the end: of the unit that commands the motors, with Trace::plant.
  Trace trace;
  std::optional<Trace> attitude_trace;   // of the attitude unit, in a flight of the cascade
  std::optional<PortFault> fault;        // of the port: the ticks before it are valid
  std::optional<Divergence> divergence;  // early end; its time counts from the first tick
};

// The metric of a whole flight (measured() in metric.hpp).
inline double measured(const Metric& metric, const Flown& flown) {
  return measured(metric, flown.trace, flown.attitude_trace ? &*flown.attitude_trace : nullptr);
}

// The case bound to this vehicle: parameters that the case does not set get the vehicle's values.
// Thrusts in units of hover thrust are scaled by the vehicle's hover thrust.
Case bound_to_vehicle(const Case& the_case, const Vehicle& vehicle);

// Errors, with the case's file: `rate` is a single rate although the flight is of the cascade, or a
// pair of rates although the flight is of the controller.
Result<void> check_rate(const Case& the_case, const LoopRate& rate);

// How often MuJoCo steps. REQUIRES: a flight.
Rate physics_of(const Case& the_case, const Rate& loop);

// The plant of a configuration. REQUIRES: the case is a flight. Errors: those of fly().
Result<std::unique_ptr<Plant>> plant_for(const Case& the_case,
                                         const RunConfiguration& configuration,
                                         const VehicleModel& vehicle_model);

// The units of a port for one flight.
struct PortUnits {
  std::unique_ptr<Unit> unit, attitude_unit;

  FlightUnits for_flight() const { return {*unit, attitude_unit.get()}; }
};

// A port of the cascade may have one of the two units; the other is then that of `other`. Faults,
// Kind::profile: the port makes no unit that the case needs, or `other` does not make the missing
// one; Kind::unsupported: the port makes either unit, but not both at the same time. REQUIRES: a
// flight.
tl::expected<PortUnits, PortFault> units_for(const Case& the_case, Port& port, Port& other);

// Flies `the_case` with fresh units, at the times that the case schedules, or at those of
// `timing`. REQUIRES: the case is a flight. Errors, with the case's file: physics slower than the
// loop, a rotor that the vehicle does not have; one rate for the cascade, or a pair of rates for
// the controller.
Result<Flown> fly(const Case& the_case, const RunConfiguration& configuration,
                  const VehicleModel& vehicle_model, FlightUnits units);
Result<Flown> fly(const Case& the_case, const RunConfiguration& configuration,
                  const VehicleModel& vehicle_model, FlightUnits units, FlightTiming timing);

}  // namespace attest
