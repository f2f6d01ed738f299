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
  TickSchedule schedule;
  schedule.rate = timing.rate;
  schedule.phase = timing.phase.on(timeline.rate);
  schedule.jitter = timing.jitter;
  schedule.seed = timing.seed;
  schedule.drops = timing.drop_ticks;
  return ticks(schedule, timing.rate.ticks_in(timeline.duration));
}

Agenda agenda_of(const Flight& flight, const Timeline& timeline, const LoopTiming& timing,
                 const std::vector<Nanoseconds>& disturbed) {
  std::vector<std::vector<Nanoseconds>> times(actuators + 1);
  times[disturbances] = disturbed;
  if (flight.battery) times[battery] = times_of(flight.battery->timing, timeline);
  times[motor_limits] = times_of(flight.motor_limits, timeline);
  for (const LoopTick& tick : timing) {
    if (tick.sampled >= Nanoseconds(0)) times[estimator].push_back(tick.sampled);
    times[unit].push_back(tick.begins);
    if (tick.commanded) times[actuators].push_back(*tick.commanded);
  }
  return Agenda(std::move(times));
}

std::size_t first_sampled(const LoopTiming& timing) {
  const auto is_sampled = [](const LoopTick& tick) { return tick.sampled >= Nanoseconds(0); };
  return static_cast<std::size_t>(std::find_if(timing.begin(), timing.end(), is_sampled) -
                                  timing.begin());
}

Nanoseconds sampled(const LoopTick& tick) { return tick.sampled; }
Nanoseconds begins(const LoopTick& tick) { return tick.begins; }
Nanoseconds commanded(const LoopTick& tick) { return tick.commanded.value_or(tick.begins); }

// The most ticks for which `from` has passed and `to` has not.
template <typename From, typename To>
std::size_t most_between(const LoopTiming& timing, const From& from, const To& to) {
  std::size_t most = 0, passed = 0;
  for (std::size_t i = 0; i < timing.size(); ++i) {
    while (to(timing[passed]) < from(timing[i])) ++passed;
    most = std::max(most, i - passed + 1);
  }
  return most;
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

ClosedLoop::ClosedLoop(const Case& the_case, const Rate& rate, LoopTiming timing,
                       const Vehicle& vehicle, Plant& plant, Unit& the_unit)
    : flight_(*the_case.flight),
      timing_(std::move(timing)),
      first_sampled_(first_sampled(timing_)),
      plant_(plant),
      disturbances_(flight_, vehicle, timeline_of(the_case, rate)),
      agenda_(agenda_of(flight_, timeline_of(the_case, rate), timing_, disturbances_.times())),
      stimulus_(the_case, rate),
      estimator_(flight_.estimator),
      supply_(flight_.battery, vehicle),
      actuators_(vehicle),
      driver_(the_unit),
      estimates_(Nanoseconds(0), most_between(timing_, &sampled, &begins) + 1),
      battery_scales_(line<float>(flight_.battery.value_or(BatteryFlight{}).timing.delay,
                                  flight_.battery.value_or(BatteryFlight{}).timing.rate, rate)),
      limits_(line<MotorLimits>(flight_.motor_limits.delay, flight_.motor_limits.rate, rate)),
      commands_(Nanoseconds(0), most_between(timing_, &begins, &commanded) + 1) {
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
      return estimates_.send_for(timing_[first_sampled_ + event.index].begins,
                                 estimator_.sample(plant_.state()));
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
  if (const auto commanded = timing_[event.index].commanded) {
    commands_.send_for(*commanded, actuators_.commands());
  }
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
