#include "harness/run/closed_loop.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "harness/schedule/ticks.hpp"

namespace attest {
namespace {

enum Task : std::size_t { disturbances, estimator, battery, motor_limits, unit, actuators };

Timeline timeline_of(const Case& the_case, const Rate& rate) {
  return {rate, rate.tick(tick_count(the_case.duration, rate))};
}

std::vector<Nanoseconds> times_of(const TaskTiming& timing, const Timeline& timeline) {
  const TickSchedule schedule{timing.rate, timing.phase.on(timeline.rate), timing.jitter,
                              timing.seed, timing.drop_ticks};
  return ticks(schedule, timing.rate.ticks_in(timeline.duration));
}

// `times` moved by `offset`, those before 0 left out.
std::vector<Nanoseconds> moved(std::vector<Nanoseconds> times, Nanoseconds offset) {
  for (Nanoseconds& time : times) time += offset;
  std::erase_if(times, [](Nanoseconds time) { return time < Nanoseconds(0); });
  return times;
}

Agenda agenda_of(const Case& the_case, const Timeline& timeline,
                 const std::vector<Nanoseconds>& disturbed) {
  const Flight& flight = *the_case.flight;
  const auto unit_times = unit_ticks(the_case, timeline.rate);
  std::vector<std::vector<Nanoseconds>> times(actuators + 1);
  times[disturbances] = disturbed;
  times[estimator] = moved(unit_times, -flight.estimator.delay.on(timeline.rate));
  if (flight.battery) times[battery] = times_of(flight.battery->timing, timeline);
  times[motor_limits] = times_of(flight.motor_limits, timeline);
  times[unit] = unit_times;
  times[actuators] = moved(unit_times, flight.actuator_delay.on(timeline.rate));
  return Agenda(std::move(times));
}

// How many messages of a task can be on their way, jitter included.
std::size_t messages(Nanoseconds delay, const Rate& rate) {
  return static_cast<std::size_t>(rate.ticks_in(delay)) + 2;
}

template <typename T>
DelayLine<T> line(const Span& delay, const Rate& task_rate, const Rate& unit_rate) {
  const Nanoseconds time = delay.on(unit_rate);
  return {time, messages(time, task_rate)};
}

template <std::size_t n>
std::array<float, n> singles(const std::array<double, n>& values) {
  std::array<float, n> result{};
  std::transform(values.begin(), values.end(), result.begin(),
                 [](double value) { return static_cast<float>(value); });
  return result;
}

// A vehicle that stands still in its attitude, or turns at its rate.
PlantState start_of(const FlightStart& start, const Vehicle& vehicle) {
  PlantState state;
  state.position_m[2] = -start.height_m;
  state.attitude = attitude_from(start.tilt_deg, start.azimuth_deg, start.yaw_deg);
  state.rate_rad_s = start.rate_rad_s;
  const double speed = start.rotors_stopped ? 0 : vehicle.hover_rotor_rad_s();
  std::fill_n(state.rotor_rad_s.begin(), vehicle.rotors.size(), speed);
  return state;
}

}  // namespace

ClosedLoop::ClosedLoop(const Case& the_case, const Rate& rate, const Vehicle& vehicle, Plant& plant,
                       Unit& the_unit)
    : flight_(*the_case.flight),
      plant_(plant),
      disturbances_(flight_, vehicle, timeline_of(the_case, rate)),
      agenda_(agenda_of(the_case, timeline_of(the_case, rate), disturbances_.times())),
      stimulus_(the_case, rate),
      estimator_(flight_.estimator),
      supply_(flight_.battery, vehicle),
      actuators_(vehicle),
      driver_(the_unit),
      estimates_(line<ControlState>(flight_.estimator.delay, rate, rate)),
      battery_scales_(line<float>(flight_.battery.value_or(BatteryFlight{}).timing.delay,
                                  flight_.battery.value_or(BatteryFlight{}).timing.rate, rate)),
      limits_(line<MotorLimits>(flight_.motor_limits.delay, flight_.motor_limits.rate, rate)),
      commands_(line<MotorCommands>(flight_.actuator_delay, rate, rate)) {
  plant_.reset(start_of(flight_.start, vehicle));
  sample_.in.control_state = control_state_of(plant_.state());
}

FlightEnd ClosedLoop::run(Trace* trace) {
  const DefaultFloatEnvironment environment;
  while (!is_over()) {
    const auto event = agenda_.next();
    end_.divergence = plant_.advance(event->time);
    if (!end_.divergence) happens(*event, trace);
  }
  return end_;
}

bool ClosedLoop::is_over() const {
  return end_.fault || end_.divergence || end_.ticks == agenda_.size(unit);
}

void ClosedLoop::happens(const Agenda::Event& event, Trace* trace) {
  const Nanoseconds now = event.time;
  switch (event.task) {
    case disturbances:
      disturbances_.apply(now, plant_);
      return hold_commands(now);  // of a motor that fails
    case estimator:
      return estimates_.send(now, estimator_.sample(plant_.state()));
    case battery: {
      const float throttle = sample_.out.actuator_controls_0.control[3];
      return battery_scales_.send(now, supply_.sample(now, plant_.state(), throttle, is_armed()));
    }
    case motor_limits:
      return limits_.send(now, actuators_.limits());
    case unit:
      unit_tick(event);
      if (trace && !end_.fault) record(*trace);
      return;
    default:
      held_ = commands_.receive(now);
      hold_commands(now);
  }
}

void ClosedLoop::unit_tick(const Agenda::Event& event) {
  changes_.clear();
  stimulus_.tick(event.index, event.time, sample_, changes_);
  attest_inputs& in = sample_.in;
  if (const auto state = estimates_.receive(event.time)) in.control_state = *state;
  if (const auto scale = battery_scales_.receive(event.time)) {
    in.battery_status.scale = *scale;
    in.updated |= ATTEST_UPDATED_BATTERY_STATUS;
  }
  if (const auto limits = limits_.receive(event.time)) {
    in.multirotor_motor_limits = *limits;
    in.updated |= ATTEST_UPDATED_MULTIROTOR_MOTOR_LIMITS;
  }
  end_.fault = ports_.run([&] { return driver_.step(event.index, changes_, sample_); });
  if (end_.fault) return;
  ++end_.ticks;
  actuators_.mix(sample_.out, is_armed());
  commands_.send(event.time, actuators_.commands());
}

void ClosedLoop::hold_commands(Nanoseconds now) {
  if (!held_) return;
  const auto speeds = actuators_.speeds(*held_, supply_.ratio(), disturbances_.failed_rotor());
  if (speeds.empty()) {
    end_.divergence = Divergence{now, "a motor command is not a number"};
    return;
  }
  plant_.command(speeds);
}

void ClosedLoop::record(Trace& trace) const {
  trace.parameters.insert(trace.parameters.end(), changes_.begin(), changes_.end());
  trace.samples.push_back(sample_);
  const PlantState& state = plant_.state();
  const Quaternion& q = state.attitude;
  const MotorLimits& limits = actuators_.limits();
  trace.plant.push_back(
      {singles(state.position_m), singles(state.velocity_m_s),
       singles(std::array<double, 4>{q.w, q.x, q.y, q.z}), singles(state.rate_rad_s),
       actuators_.commands(), singles(state.rotor_rad_s), static_cast<float>(supply_.voltage_V()),
       std::uint8_t{(limits.lower_limit | limits.upper_limit | limits.yaw) != 0}});
}

}  // namespace attest
