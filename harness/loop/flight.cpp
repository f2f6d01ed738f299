#include "harness/loop/flight.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "harness/core/large_pages.hpp"
#include "harness/loop/case_timing.hpp"
#include "harness/loop/closed_loop.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/port/builtin.hpp"

namespace attest {
namespace {

// Fast compared with the rotors' lag and the body's rates. At this rate the error of MuJoCo's
// Runge-Kutta is below the rounding of the unit's inputs to float32 (models/README.md).
const Rate slowest_physics = Rate::hz(1000);

Result<void> check(const Case& the_case, const RunConfiguration& configuration,
                   const Vehicle& vehicle) {
  const Flight& flight = *the_case.flight;
  if (auto sane = check_rate(the_case, configuration.rate); !sane) return sane;
  if (physics_of(the_case, configuration.rate.motor_unit) < configuration.rate.motor_unit) {
    return fail_at(the_case.file.string(),
                   fmt::format("physics at {} Hz is slower than the loop at {} Hz; raise "
                               "`physics_hz`, or leave it out",
                               flight.physics->to_string(), configuration.rate.to_string()),
                   flight.physics_line);
  }
  if (flight.motor_failure && flight.motor_failure->rotor >= vehicle.rotors.size()) {
    return fail_at(
        the_case.file.string(),
        fmt::format("[flight.motor_failure] names rotor {}, but {} has rotors 0 to {}",
                    flight.motor_failure->rotor, vehicle.name, vehicle.rotors.size() - 1));
  }
  return {};
}

void scale_thrusts(std::vector<TopicStimulus>& topics, const Vehicle& vehicle) {
  for (TopicStimulus& topic : topics) {
    for (FieldStimulus& field : topic.fields) {
      if (field.of_hover) field.scale = vehicle.hover_thrust();
    }
  }
}

// Sets MPC_THR_HOVER, unless it is set, so that the vehicle hovers at a centred throttle stick.
void add_hover_thrust(const Vehicle& vehicle, Case& the_case) {
  constexpr const char* name = "MPC_THR_HOVER";
  for (const ParameterStimulus& own : the_case.parameters) {
    if (own.name == name) return;
  }
  the_case.parameters.push_back({name, Constant{vehicle.hover_thrust()}});
}

PortFault no_profile(const std::string& profile) {
  return {PortFault::Kind::profile, 0,
          fmt::format("the port does not support profile {}", profile)};
}

// units_for() makes the rate unit first, so the attitude unit is the one that is missing.
PortFault makes_one_at_a_time() {
  return {PortFault::Kind::unsupported, 0,
          "the port makes no attitude unit while it has a rate unit: create() returned NULL"};
}

}  // namespace

Result<void> check_rate(const Case& the_case, const LoopRate& rate) {
  const std::string file = the_case.file.string();
  if (the_case.attitude_loop && !rate.attitude_unit) {
    return fail_at(file, fmt::format("is a flight of the cascade, which needs two rates: that of "
                                     "the attitude unit and that of the rate unit, as in 250:1000, "
                                     "not {}",
                                     rate.to_string()));
  }
  if (!the_case.attitude_loop && rate.attitude_unit) {
    return fail_at(file, fmt::format("is a flight of the controller, which has one rate, as in {}",
                                     rate.motor_unit.to_string()));
  }
  return {};
}

Rate physics_of(const Case& the_case, const Rate& loop) {
  return the_case.flight->physics.value_or(std::max(slowest_physics, loop));
}

Case bound_to_vehicle(const Case& the_case, const Vehicle& vehicle) {
  Case result = the_case;
  result.parameters.clear();
  for (const auto& entry : vehicle.parameters) {
    const std::string& name = entry.first;
    const auto is_this = [&](const ParameterStimulus& own) { return own.name == name; };
    if (std::any_of(the_case.parameters.begin(), the_case.parameters.end(), is_this)) continue;
    result.parameters.push_back({name, Constant{entry.second}});
  }
  result.parameters.insert(result.parameters.end(), the_case.parameters.begin(),
                           the_case.parameters.end());
  if (the_case.attitude_loop) add_hover_thrust(vehicle, result);
  scale_thrusts(result.topics, vehicle);
  if (result.attitude_loop) scale_thrusts(result.attitude_loop->topics, vehicle);
  return result;
}

Result<std::unique_ptr<Plant>> plant_for(const Case& the_case,
                                         const RunConfiguration& configuration,
                                         const VehicleModel& vehicle_model) {
  const Flight& flight = *the_case.flight;
  if (auto sane = check(the_case, configuration, vehicle_model.vehicle()); !sane) {
    return tl::unexpected(sane.error());
  }
  return vehicle_model.make_plant(
      configuration.plant_configuration->plant,
      {physics_of(the_case, configuration.rate.motor_unit), flight.floor});
}

tl::expected<PortUnits, PortFault> units_for(const Case& the_case, Port& port) {
  const auto made_by = [&](Port& maker, Module module) -> std::unique_ptr<Unit> {
    if (!contains(maker.modules(), module)) return nullptr;
    return maker.create_unit(module, the_case.profile, "");
  };
  constexpr Module attitude_unit = Module::attitude_unit;
  PortUnits units{nullptr, made_by(port, the_case.module), nullptr};
  if (the_case.attitude_loop) units.attitude_unit = made_by(port, attitude_unit);
  if (!units.unit && !units.attitude_unit) {
    return tl::unexpected(why_no_unit(port, {the_case.profile, the_case.module}));
  }
  if (units.unit && units.attitude_unit) return units;
  if (units.unit && the_case.attitude_loop && contains(port.modules(), attitude_unit)) {
    units.unit = nullptr;
    if (made_by(port, attitude_unit)) return tl::unexpected(makes_one_at_a_time());
    units.unit = made_by(port, the_case.module);
  }
  units.reference = open_builtin();
  if (!units.unit) units.unit = made_by(*units.reference, the_case.module);
  if (the_case.attitude_loop && !units.attitude_unit) {
    units.attitude_unit = made_by(*units.reference, attitude_unit);
  }
  const bool is_complete = units.unit && (units.attitude_unit || !the_case.attitude_loop);
  if (!is_complete) return tl::unexpected(no_profile(the_case.profile));
  return units;
}

Result<Flown> fly(const Case& the_case, const RunConfiguration& configuration,
                  const VehicleModel& vehicle_model, FlightUnits units) {
  if (auto sane = check_rate(the_case, configuration.rate); !sane) {
    return tl::unexpected(sane.error());
  }
  return fly(the_case, configuration, vehicle_model, units,
             flight_timing(the_case, configuration.rate));
}

Result<Flown> fly(const Case& the_case, const RunConfiguration& configuration,
                  const VehicleModel& vehicle_model, FlightUnits units, FlightTiming timing) {
  auto plant = plant_for(the_case, configuration, vehicle_model);
  if (!plant) return tl::unexpected(plant.error());
  const Case scripted = bound_to_vehicle(the_case, vehicle_model.vehicle());
  Flown flown;
  const auto prepare = [&](Trace& trace, Module module, std::size_t ticks) {
    trace.source = the_case.id_at(configuration);
    trace.present = channels_of(module);
    reserve_large(trace.samples, ticks);
  };
  prepare(flown.trace, the_case.module, timing.unit.size());
  reserve_large(flown.trace.plant, timing.unit.size());
  if (the_case.attitude_loop) {
    prepare(flown.attitude_trace.emplace(), Module::attitude_unit, timing.attitude_unit.size());
  }
  ClosedLoop loop(scripted, configuration.rate, std::move(timing), vehicle_model.vehicle(), **plant,
                  units);
  FlightEnd end = loop.run({&flown.trace, flown.attitude_trace ? &*flown.attitude_trace : nullptr});
  flown.fault = std::move(end.fault);
  flown.divergence = std::move(end.divergence);
  return flown;
}

}  // namespace attest
