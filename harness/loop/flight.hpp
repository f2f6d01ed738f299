// Flies a case with the units of a port, and returns the recorded traces.
#pragma once

#include <memory>
#include <optional>

#include "harness/casefile/case.hpp"
#include "harness/core/loop_timing.hpp"
#include "harness/core/result.hpp"
#include "harness/loop/closed_loop.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/plant/plant.hpp"
#include "harness/port/port.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

struct Flown {
  // All finished ticks of the unit that commands the motors, with Trace::plant.
  Trace trace;
  std::optional<Trace> attitude_trace;   // of the attitude unit, in a flight of the cascade
  std::optional<PortFault> fault;        // of the port; the traces end before it
  std::optional<Divergence> divergence;  // early end; its time is since the start of the case
};

// Same as measured() of metric.hpp, with both traces of the flight.
inline double measured(const Metric& metric, const Flown& flown) {
  return measured(metric, flown.trace, flown.attitude_trace ? &*flown.attitude_trace : nullptr);
}

// Returns the case bound to this vehicle: parameters that the case does not set get the vehicle's
// values. In a flight of the cascade MPC_THR_HOVER, if it is not set, is the vehicle's hover
// thrust. Thrusts in units of hover thrust are scaled by the vehicle's hover thrust.
Case bound_to_vehicle(const Case& the_case, const Vehicle& vehicle);

// Errors, with the case's file: one rate for a flight of the cascade, or two rates for a flight of
// the controller. REQUIRES: a flight.
Result<void> check_rate(const Case& the_case, const LoopRate& rate);

// The rate of MuJoCo's steps. `loop`: the rate of the unit that commands the motors. REQUIRES: a
// flight.
Rate physics_of(const Case& the_case, const Rate& loop);

// Makes the plant of a configuration. REQUIRES: a flight. Errors: those of fly().
Result<std::unique_ptr<Plant>> plant_for(const Case& the_case,
                                         const RunConfiguration& configuration,
                                         const VehicleModel& vehicle_model);

struct PortUnits {
  std::unique_ptr<Port> reference;  // makes the unit that the port does not have; else null
  std::unique_ptr<Unit> unit, attitude_unit;

  FlightUnits for_flight() const { return {*unit, attitude_unit.get()}; }
};

// Makes the units of a flight by `port`. A port of the cascade may have only one of the two units:
// then the reference makes the missing one. REQUIRES: a flight. Faults:
// - Kind::profile: `port` makes no unit that the case needs
// - Kind::module: it makes another module of the profile, such as a law alone, and no unit that the
//   case needs
// - Kind::unsupported: it makes each of the two units, but not both at the same time
tl::expected<PortUnits, PortFault> units_for(const Case& the_case, Port& port);

// Flies `the_case`, at the times that the case schedules, or at those of `timing`. REQUIRES: a
// flight; units in their power-on state. Errors, with the case's file: those of check_rate();
// physics slower than the loop; a motor failure of a rotor that the vehicle does not have; a floor
// for a plant without ground contact.
Result<Flown> fly(const Case& the_case, const RunConfiguration& configuration,
                  const VehicleModel& vehicle_model, FlightUnits units);
Result<Flown> fly(const Case& the_case, const RunConfiguration& configuration,
                  const VehicleModel& vehicle_model, FlightUnits units, FlightTiming timing);

}  // namespace attest
