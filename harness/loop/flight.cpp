#include "harness/loop/flight.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "harness/core/large_pages.hpp"
#include "harness/loop/case_timing.hpp"
#include "harness/loop/closed_loop.hpp"

namespace attest {
namespace {

// Fast compared with the rotors' lag and the body's rates. At this rate MuJoCo's Runge-Kutta errs
// by less than the float32 of the unit's inputs (models/README.md).
const Rate slowest_physics = Rate::hz(1000);

Result<void> check(const Case& the_case, const RunConfiguration& configuration,
                   const Vehicle& vehicle) {
  const Flight& flight = *the_case.flight;
  if (physics_of(the_case, configuration.rate) < configuration.rate) {
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

}  // namespace

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
  for (TopicStimulus& topic : result.topics) {
    for (FieldStimulus& field : topic.fields) {
      if (field.of_hover) field.scale = vehicle.hover_thrust();
    }
  }
  return result;
}

Result<std::unique_ptr<Plant>> plant_for(const Case& the_case,
                                         const RunConfiguration& configuration,
                                         const VehicleModel& vehicle_model) {
  const Flight& flight = *the_case.flight;
  if (auto sane = check(the_case, configuration, vehicle_model.vehicle()); !sane) {
    return tl::unexpected(sane.error());
  }
  return vehicle_model.make_plant(configuration.plant_configuration->plant,
                                  {physics_of(the_case, configuration.rate), flight.floor});
}

Result<Flown> fly(const Case& the_case, const RunConfiguration& configuration,
                  const VehicleModel& vehicle_model, Unit& unit) {
  return fly(the_case, configuration, vehicle_model, unit,
             case_timing(the_case, configuration.rate));
}

Result<Flown> fly(const Case& the_case, const RunConfiguration& configuration,
                  const VehicleModel& vehicle_model, Unit& unit, LoopTiming timing) {
  auto plant = plant_for(the_case, configuration, vehicle_model);
  if (!plant) return tl::unexpected(plant.error());
  const Case scripted = bound_to_vehicle(the_case, vehicle_model.vehicle());
  const std::size_t ticks = timing.size();
  ClosedLoop loop(scripted, configuration.rate, std::move(timing), vehicle_model.vehicle(), **plant,
                  unit);

  Flown flown;
  flown.trace.source = the_case.id_at(configuration);
  flown.trace.present = channels_of(Module::mc_att_control);
  reserve_large(flown.trace.samples, ticks);
  reserve_large(flown.trace.plant, ticks);
  FlightEnd end = loop.run(&flown.trace);
  flown.fault = std::move(end.fault);
  flown.divergence = std::move(end.divergence);
  return flown;
}

}  // namespace attest
