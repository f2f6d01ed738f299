#include "harness/loop/closed_loop.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/loop/case_timing.hpp"

namespace attest {
namespace {

enum Task : std::size_t {
  disturbances,
  battery,
  saturation,
  land_detector,
  estimator,
  attitude_estimator,
  unit,
  attitude_unit,
  actuators
};

std::size_t first_sampled_in(const LoopTiming& timing) {
  const auto is_sampled = [](const LoopTick& tick) { return tick.sampled >= Nanoseconds(0); };
  return static_cast<std::size_t>(std::find_if(timing.begin(), timing.end(), is_sampled) -
                                  timing.begin());
}

Nanoseconds sampled(const LoopTick& tick) { return tick.sampled; }
Nanoseconds begins(const LoopTick& tick) { return tick.begins; }
Nanoseconds commanded(const LoopTick& tick) { return tick.commanded.value_or(tick.begins); }

// The largest number of ticks whose intervals from(tick) to to(tick) overlap at one time.
template <typename From, typename To>
std::size_t most_between(const LoopTiming& timing, const From& from, const To& to) {
  std::size_t most = 0, passed = 0;
  for (std::size_t i = 0; i < timing.size(); ++i) {
    while (to(timing[passed]) < from(timing[i])) ++passed;
    most = std::max(most, i - passed + 1);
  }
  return most;
}

// The largest number of a task's messages that are on their way at one time, with jitter.
std::size_t messages(Nanoseconds delay, const Rate& rate) {
  return static_cast<std::size_t>(rate.ticks_in(delay)) + 2;
}

template <typename T>
DelayLine<T> line(const TaskTiming& task, const Rate& unit_rate) {
  const Nanoseconds delay = task.delay.on(unit_rate);
  return {delay, messages(delay, task.rate)};
}

template <std::size_t n>
std::array<float, n> singles(const std::array<double, n>& values) {
  std::array<float, n> result{};
  std::transform(values.begin(), values.end(), result.begin(),
                 [](double value) { return static_cast<float>(value); });
  return result;
}

void add_samples(const LoopTiming& timing, std::vector<Nanoseconds>& times) {
  for (const LoopTick& tick : timing) {
    if (tick.sampled >= Nanoseconds(0)) times.push_back(tick.sampled);
  }
}

void add_ticks(const LoopTiming& timing, std::vector<Nanoseconds>& times) {
  for (const LoopTick& tick : timing) times.push_back(tick.begins);
}

void append(const UnitTask& task, Trace& trace) {
  trace.parameters.insert(trace.parameters.end(), task.changes().begin(), task.changes().end());
  trace.samples.push_back(task.sample());
}

// Adds the name of the unit to its fault. Both units of the cascade count their ticks from 0, so
// the tick alone does not identify the unit.
std::optional<PortFault> named(std::optional<PortFault> fault, Module module) {
  if (fault) fault->what = fmt::format("{}: {}", info_of(module).title, fault->what);
  return fault;
}

Estimate estimate_at_start(const Case& the_case, const Rate& rate, const PlantState& state) {
  Case exact = the_case;
  exact.flight->estimator = {};
  return UnitEstimator(exact, rate, rate).sample(Nanoseconds(0), state);
}

}  // namespace

ClosedLoop::UnitLoop::UnitLoop(const Case& the_case, const Rate& own, const Rate& timeline,
                               LoopTiming times, const Vehicle& vehicle, Unit& unit,
                               const PlantState& start)
    : scripted(the_case),
      timing(std::move(times)),
      first_sampled(first_sampled_in(timing)),
      estimator(scripted, own, timeline),
      task(scripted, timeline, vehicle, unit, estimate_at_start(scripted, own, start)),
      estimates(Nanoseconds(0), most_between(timing, &sampled, &begins) + 1),
      landed(line<LandDetected>(land_detection(), timeline)) {}

ClosedLoop::ClosedLoop(const Case& the_case, const LoopRate& rate, FlightTiming timing,
                       const Vehicle& vehicle, Plant& plant, FlightUnits units)
    : plant_(the_case, rate.motor_unit, vehicle, plant),
      unit_(the_case.of_module(the_case.module), rate.motor_unit, rate.motor_unit,
            std::move(timing.unit), vehicle, units.unit, plant_.state()),
      land_detector_(the_case, rate.motor_unit),
      event_queue_({}),
      battery_scales_(
          line<float>(the_case.flight->battery.value_or(BatteryFlight{}).timing, rate.motor_unit)),
      saturations_(line<Saturation>(the_case.flight->saturation, rate.motor_unit)),
      rates_setpoints_(Nanoseconds(0), most_between(timing.attitude_unit, &begins, &commanded) + 1),
      commands_(Nanoseconds(0), most_between(unit_.timing, &begins, &commanded) + 1) {
  if (the_case.attitude_loop) {
    attitude_unit_.emplace(the_case.of_module(Module::attitude_unit), *rate.attitude_unit,
                           rate.motor_unit, std::move(timing.attitude_unit), vehicle,
                           *units.attitude_unit, plant_.state());
  }
  event_queue_ = events_of(the_case, rate.motor_unit);
}

EventQueue ClosedLoop::events_of(const Case& the_case, const Rate& rate) const {
  const Flight& flight = *the_case.flight;
  const Timeline timeline = timeline_of(the_case, rate);
  std::vector<std::vector<Nanoseconds>> times(actuators + 1);
  times[disturbances] = plant_.disturbance_times();
  if (flight.battery) times[battery] = task_times(flight.battery->timing, timeline);
  times[saturation] = task_times(flight.saturation, timeline);
  add_samples(unit_.timing, times[estimator]);
  add_ticks(unit_.timing, times[unit]);
  if (attitude_unit_) {
    if (flight.floor) times[land_detector] = task_times(land_detection(), timeline);
    add_samples(attitude_unit_->timing, times[attitude_estimator]);
    add_ticks(attitude_unit_->timing, times[attitude_unit]);
  }
  for (const LoopTick& tick : unit_.timing) {
    if (tick.commanded) times[actuators].push_back(*tick.commanded);
  }
  return EventQueue(std::move(times));
}

FlightEnd ClosedLoop::run(FlightTraces traces) {
  const DefaultFloatEnvironment environment;
  traces_ = traces;
  while (!is_over()) {
    const auto event = event_queue_.next();
    end_.divergence = plant_.advance(event->time);
    if (!end_.divergence) happens(*event);
  }
  return end_;
}

bool ClosedLoop::is_over() const {
  if (end_.fault || end_.divergence) return true;
  return end_.ticks == unit_.timing.size() &&
         (!attitude_unit_ || end_.attitude_ticks == attitude_unit_->timing.size());
}

void ClosedLoop::happens(const EventQueue::Event& event) {
  const Nanoseconds now = event.time;
  switch (event.task) {
    case disturbances:
      end_.divergence = plant_.disturb(now);
      return;
    case battery:
      return battery_scales_.send(
          now, plant_.battery_scale(now, unit_.task.throttle(), unit_.task.is_armed()));
    case saturation:
      return saturations_.send(now, unit_.task.saturation());
    case land_detector:
      return detect_landing(now);
    case estimator:
      return sample(unit_, event);
    case attitude_estimator:
      return sample(*attitude_unit_, event);
    case unit:
      return tick(event);
    case attitude_unit:
      return attitude_tick(event);
    default:
      if (const auto commands = commands_.receive(now)) {
        end_.divergence = plant_.command(now, *commands);
      }
  }
}

void ClosedLoop::sample(UnitLoop& of, const EventQueue::Event& event) {
  of.estimates.send_for(of.timing[of.first_sampled + event.index].begins,
                        of.estimator.sample(event.time, plant_.state()));
}

void ClosedLoop::detect_landing(Nanoseconds now) {
  const UnitTask& task = unit_.task;
  const LandDetected landed =
      land_detector_.sample(now, plant_.state(), task.throttle(), task.is_armed());
  unit_.landed.send(now, landed);
  attitude_unit_->landed.send(now, landed);
}

void ClosedLoop::tick(const EventQueue::Event& event) {
  const Nanoseconds now = event.time;
  end_.fault = unit_.task.tick(
      event.index, now,
      {unit_.estimates.receive(now), battery_scales_.receive(now), saturations_.receive(now),
       unit_.landed.receive(now), rates_setpoints_.receive(now)});
  if (end_.fault) {
    if (attitude_unit_) end_.fault = named(std::move(end_.fault), unit_.task.module());
    return;
  }
  ++end_.ticks;
  if (const auto commanded = unit_.timing[event.index].commanded) {
    commands_.send_for(*commanded, unit_.task.commands());
  }
  if (traces_.unit) record(*traces_.unit);
}

void ClosedLoop::attitude_tick(const EventQueue::Event& event) {
  const Nanoseconds now = event.time;
  UnitLoop& attitude = *attitude_unit_;
  end_.fault = attitude.task.tick(event.index, now,
                                  {attitude.estimates.receive(now), std::nullopt, std::nullopt,
                                   attitude.landed.receive(now), std::nullopt});
  if (end_.fault) {
    end_.fault = named(std::move(end_.fault), Module::attitude_unit);
    return;
  }
  ++end_.attitude_ticks;
  const auto arrives = attitude.timing[event.index].commanded;
  const auto setpoint = rates_setpoint_of(attitude.task.sample().attitude_out);
  if (arrives && setpoint) rates_setpoints_.send_for(*arrives, *setpoint);
  if (traces_.attitude_unit) append(attitude.task, *traces_.attitude_unit);
}

void ClosedLoop::record(Trace& trace) const {
  append(unit_.task, trace);
  const PlantState& state = plant_.state();
  const Quaternion& q = state.attitude;
  trace.plant.push_back({singles(state.position_m), singles(state.velocity_m_s),
                         singles(std::array<double, 4>{q.w, q.x, q.y, q.z}),
                         singles(state.rate_rad_s), unit_.task.commands(),
                         singles(state.rotor_rad_s), static_cast<float>(plant_.voltage_V()),
                         static_cast<std::uint8_t>(unit_.task.saturation().any())});
}

}  // namespace attest
