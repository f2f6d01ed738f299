#include "harness/loop/plant_task.hpp"

#include <algorithm>

#include "harness/casefile/stimulus.hpp"
#include "harness/loop/land_detector.hpp"

namespace attest {
namespace {

PlantState start_of(const FlightStart& start, const Vehicle& vehicle) {
  PlantState state;
  state.position_m[2] = -(start.on_floor ? height_on_floor_m(vehicle) : start.height_m);
  state.attitude = start.attitude;
  state.rate_rad_s = start.rate_rad_s;
  const double speed = start.rotors_stopped ? 0 : vehicle.hover_rotor_rad_s();
  std::fill_n(state.rotor_rad_s.begin(), vehicle.rotors.size(), speed);
  return state;
}

}  // namespace

PlantTask::PlantTask(const Case& the_case, const Rate& rate, const Vehicle& vehicle, Plant& plant)
    : plant_(plant),
      disturbances_(*the_case.flight, vehicle, timeline_of(the_case, rate)),
      supply_(the_case.flight->battery, vehicle),
      actuators_(vehicle) {
  plant_.reset(start_of(the_case.flight->start, vehicle));
}

std::optional<Divergence> PlantTask::disturb(Nanoseconds now) {
  disturbances_.apply(now, plant_);
  return hold(now);  // the commanded speed of a motor that fails becomes 0 now
}

std::optional<Divergence> PlantTask::command(Nanoseconds now, const MotorCommands& commands) {
  held_ = commands;
  return hold(now);
}

std::optional<Divergence> PlantTask::hold(Nanoseconds now) {
  if (!held_) return std::nullopt;
  const auto speeds = actuators_.speeds(*held_, supply_.ratio(), disturbances_.failed_rotor());
  if (speeds.empty()) return Divergence{now, "a motor command is not a number"};
  plant_.command(speeds);
  return std::nullopt;
}

}  // namespace attest
