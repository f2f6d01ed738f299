#include "harness/loop/closed_loop.hpp"

#include <algorithm>

#include "harness/casefile/stimulus.hpp"
#include "harness/loop/case_timing.hpp"

namespace attest {
namespace {

enum Task : std::size_t { disturbances, estimator, battery, motor_limits, unit, actuators };

EventQueue event_queue_of(const Flight& flight, const Timeline& timeline, const LoopTiming& timing,
                          const std::vector<Nanoseconds>& disturbed) {
  std::vector<std::vector<Nanoseconds>> times(actuators + 1);
  times[disturbances] = disturbed;
  if (flight.battery) times[battery] = task_times(flight.battery->timing, timeline);
  times[motor_limits] = task_times(flight.motor_limits, timeline);
  for (const LoopTick& tick : timing) {
    if (tick.sampled >= Nanoseconds(0)) times[estimator].push_back(tick.sampled);
    times[unit].push_back(tick.begins);
    if (tick.commanded) times[actuators].push_back(*tick.commanded);
  }
  return EventQueue(std::move(times));
}

std::size_t first_sampled(const LoopTiming& timing) {
  const auto is_sampled = [](const LoopTick& tick) { return tick.sampled >= Nanoseconds(0); };
  return static_cast<std::size_t>(std::find_if(timing.begin(), timing.end(), is_sampled) -
                                  timing.begin());
}

Nanoseconds sampled(const LoopTick& tick) { return tick.sampled; }
Nanoseconds begins(const LoopTick& tick) { return tick.begins; }
Nanoseconds commanded(const LoopTick& tick) { return tick.commanded.value_or(tick.begins); }

// The largest number of ticks that are between their `from` and their `to` at the same time.
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

}  // namespace

ClosedLoop::ClosedLoop(const Case& the_case, const Rate& rate, LoopTiming timing,
                       const Vehicle& vehicle, Plant& plant, Unit& unit)
    : timing_(std::move(timing)),
      first_sampled_(first_sampled(timing_)),
      plant_(the_case, rate, vehicle, plant),
      unit_(the_case, rate, vehicle, unit, control_state_of(plant_.state())),
      estimator_(the_case.flight->estimator),
      event_queue_(event_queue_of(*the_case.flight, timeline_of(the_case, rate), timing_,
                                  plant_.disturbance_times())),
      estimates_(Nanoseconds(0), most_between(timing_, &sampled, &begins) + 1),
      battery_scales_(line<float>(the_case.flight->battery.value_or(BatteryFlight{}).timing, rate)),
      limits_(line<MotorLimits>(the_case.flight->motor_limits, rate)),
      commands_(Nanoseconds(0), most_between(timing_, &begins, &commanded) + 1) {}

FlightEnd ClosedLoop::run(Trace* trace) {
  const DefaultFloatEnvironment environment;
  while (!is_over()) {
    const auto event = event_queue_.next();
    end_.divergence = plant_.advance(event->time);
    if (!end_.divergence) happens(*event, trace);
  }
  return end_;
}

bool ClosedLoop::is_over() const {
  return end_.fault || end_.divergence || end_.ticks == timing_.size();
}

void ClosedLoop::happens(const EventQueue::Event& event, Trace* trace) {
  const Nanoseconds now = event.time;
  switch (event.task) {
    case disturbances:
      end_.divergence = plant_.disturb(now);
      return;
    case estimator:
      return estimates_.send_for(timing_[first_sampled_ + event.index].begins,
                                 {now, estimator_.sample(plant_.state())});
    case battery: {
      const float throttle = unit_.sample().out.actuator_controls_0.control[3];
      return battery_scales_.send(now, plant_.battery_scale(now, throttle, unit_.is_armed()));
    }
    case motor_limits:
      return limits_.send(now, unit_.limits());
    case unit:
      unit_tick(event);
      if (trace && !end_.fault) record(*trace);
      return;
    default:
      if (const auto commands = commands_.receive(now)) {
        end_.divergence = plant_.command(now, *commands);
      }
  }
}

void ClosedLoop::unit_tick(const EventQueue::Event& event) {
  const Nanoseconds now = event.time;
  end_.fault =
      unit_.tick(event.index, now,
                 {estimates_.receive(now), battery_scales_.receive(now), limits_.receive(now)});
  if (end_.fault) return;
  ++end_.ticks;
  if (const auto commanded = timing_[event.index].commanded) {
    commands_.send_for(*commanded, unit_.commands());
  }
}

void ClosedLoop::record(Trace& trace) const {
  trace.parameters.insert(trace.parameters.end(), unit_.changes().begin(), unit_.changes().end());
  trace.samples.push_back(unit_.sample());
  const PlantState& state = plant_.state();
  const Quaternion& q = state.attitude;
  const MotorLimits& limits = unit_.limits();
  trace.plant.push_back(
      {singles(state.position_m), singles(state.velocity_m_s),
       singles(std::array<double, 4>{q.w, q.x, q.y, q.z}), singles(state.rate_rad_s),
       unit_.commands(), singles(state.rotor_rad_s), static_cast<float>(plant_.voltage_V()),
       std::uint8_t{(limits.lower_limit | limits.upper_limit | limits.yaw) != 0}});
}

}  // namespace attest
