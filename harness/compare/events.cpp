#include "harness/compare/events.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "harness/trace/output_topics.hpp"

namespace attest {
namespace {

enum class State { no, yes, unclear };

// A property of one output, such as `published`: yes, no or unclear at each tick.
struct Kind {
  Module module;
  const char* channel;
  State (*at)(const Trace& trace, std::size_t tick, const Channel& channel);
  const char* yes;  // the text for messages
  const char* no;
};

State published(const Trace& trace, std::size_t tick, const Channel& channel) {
  return value_of(channel, trace.samples[tick]) != 0 ? State::yes : State::no;
}

State finite(const Trace& trace, std::size_t tick, const Channel& channel) {
  const Sample& sample = trace.samples[tick];
  if (!is_published(channel, sample)) return State::unclear;
  return std::isfinite(float_of(channel, sample)) ? State::yes : State::no;
}

// The step of an integral since the tick before; empty if one of them is not published.
std::optional<double> step_of(const Trace& trace, std::size_t tick, const Channel& channel) {
  const auto is_there = [&](std::size_t at) { return is_published(channel, trace.samples[at]); };
  if (tick == 0 || !is_there(tick) || !is_there(tick - 1)) return std::nullopt;
  return static_cast<double>(float_of(channel, trace.samples[tick])) -
         static_cast<double>(float_of(channel, trace.samples[tick - 1]));
}

// An integral moves if its step is above this noise, a fraction of the integrals' tolerance: that
// tolerance is the deviation that may add up over the whole run.
State above_noise(double step) {
  constexpr double still = 1e-6, surely = 4e-6;
  if (step > surely) return State::yes;
  return step < still ? State::no : State::unclear;
}

State moving(const Trace& trace, std::size_t tick, const Channel& channel) {
  const auto step = step_of(trace, tick, channel);
  return step ? above_noise(std::abs(*step)) : State::unclear;
}

State rising(const Trace& trace, std::size_t tick, const Channel& channel) {
  const auto step = step_of(trace, tick, channel);
  return step ? above_noise(*step) : State::unclear;
}

State falling(const Trace& trace, std::size_t tick, const Channel& channel) {
  const auto step = step_of(trace, tick, channel);
  return step ? above_noise(-*step) : State::unclear;
}

State beyond_thrust(const Trace& trace, std::size_t tick, const Channel& channel) {
  constexpr double near = 1e-3;
  const Sample& sample = trace.samples[tick];
  if (!is_published(channel, sample)) return State::unclear;
  const double over = std::abs(static_cast<double>(float_of(channel, sample))) -
                      static_cast<double>(sample.out.actuator_controls_0.control[3]);
  if (std::abs(over) < near) return State::unclear;
  return over > 0 ? State::yes : State::no;
}

#define PUBLISHED(topic) \
  { Module::MODULE, "out/" topic ".published", published, "published", "not published" }
#define FINITE(signal) \
  { Module::MODULE, "out/" signal, finite, "finite", "not finite" }
#define BEYOND_THRUST(signal) \
  { Module::MODULE, "out/" signal, beyond_thrust, "beyond the thrust", "within it" }
#define MOVING(signal) \
  { Module::MODULE, "out/" signal, moving, "moving", "still" }
// Both directions: a saturation flag of the rate unit stops one of them.
#define RISING_FALLING(signal)                                       \
  {Module::MODULE, "out/" signal, rising, "rising", "not rising"}, { \
    Module::MODULE, "out/" signal, falling, "falling", "not falling" \
  }

constexpr Kind kinds[] = {
#define MODULE mc_att_control
    PUBLISHED("vehicle_rates_setpoint"),
    PUBLISHED("actuator_controls_0"),
    PUBLISHED("mc_att_ctrl_status"),
    FINITE("vehicle_rates_setpoint.roll"),
    FINITE("vehicle_rates_setpoint.pitch"),
    FINITE("vehicle_rates_setpoint.yaw"),
    BEYOND_THRUST("actuator_controls_0.control[0]"),
    BEYOND_THRUST("actuator_controls_0.control[1]"),
    BEYOND_THRUST("actuator_controls_0.control[2]"),
    MOVING("mc_att_ctrl_status.roll_rate_integ"),
    MOVING("mc_att_ctrl_status.pitch_rate_integ"),
    MOVING("mc_att_ctrl_status.yaw_rate_integ"),
#undef MODULE
#define MODULE attitude_unit
    PUBLISHED("vehicle_rates_setpoint"),
    PUBLISHED("vehicle_attitude_setpoint"),
    FINITE("vehicle_rates_setpoint.roll"),
    FINITE("vehicle_rates_setpoint.pitch"),
    FINITE("vehicle_rates_setpoint.yaw"),
    FINITE("vehicle_rates_setpoint.thrust_body[2]"),
#undef MODULE
#define MODULE rate_unit
    PUBLISHED("vehicle_torque_setpoint"),
    PUBLISHED("vehicle_thrust_setpoint"),
    PUBLISHED("rate_ctrl_status"),
    PUBLISHED("vehicle_rates_setpoint"),
    FINITE("vehicle_thrust_setpoint.xyz[2]"),
    FINITE("vehicle_rates_setpoint.roll"),
    FINITE("vehicle_rates_setpoint.pitch"),
    FINITE("vehicle_rates_setpoint.yaw"),
    RISING_FALLING("rate_ctrl_status.rollspeed_integ"),
    RISING_FALLING("rate_ctrl_status.pitchspeed_integ"),
    RISING_FALLING("rate_ctrl_status.yawspeed_integ"),
#undef MODULE
};

#undef PUBLISHED
#undef FINITE
#undef BEYOND_THRUST
#undef MOVING
#undef RISING_FALLING

std::size_t channel_of(const Kind& kind) { return *find_channel(kind.module, kind.channel); }

std::vector<State> states(const Kind& kind, const Trace& trace, const Channel& channel) {
  std::vector<State> all;
  for (std::size_t tick = 0; tick < trace.samples.size(); ++tick) {
    all.push_back(kind.at(trace, tick, channel));
  }
  return all;
}

// True if `state` or an unclear state is within a tick of `tick`. Also true at the first and the
// last tick, because the states before and after the trace are unknown.
bool has_near(const std::vector<State>& states, std::size_t tick, State state) {
  if (tick == 0 || tick + 1 == states.size()) return true;
  for (std::size_t i = tick - 1; i <= tick + 1; ++i) {
    if (states[i] == state || states[i] == State::unclear) return true;
  }
  return false;
}

std::optional<std::size_t> first_difference(const std::vector<State>& got,
                                            const std::vector<State>& want) {
  for (std::size_t tick = 0; tick < want.size(); ++tick) {
    const bool extra = got[tick] != State::unclear && !has_near(want, tick, got[tick]);
    const bool missing = want[tick] != State::unclear && !has_near(got, tick, want[tick]);
    if (extra || missing) return tick;
  }
  return std::nullopt;
}

}  // namespace

bool has_events(Module module) {
  return std::any_of(std::begin(kinds), std::end(kinds),
                     [&](const Kind& kind) { return kind.module == module; });
}

bool tells_events(const ChannelSet& present) {
  return std::any_of(std::begin(kinds), std::end(kinds),
                     [&](const Kind& kind) { return present[channel_of(kind)]; });
}

bool is_before(const EventDifference& a, const EventDifference& b) {
  return std::pair(a.tick, channels()[a.channel].stage) <
         std::pair(b.tick, channels()[b.channel].stage);
}

std::optional<EventDifference> first_event_difference(const Trace& got, const Trace& want) {
  std::optional<EventDifference> first;
  for (const Kind& kind : kinds) {
    const std::size_t index = channel_of(kind);
    if (!want.present[index]) continue;
    const Channel& channel = channels()[index];
    const auto of_got = states(kind, got, channel), of_want = states(kind, want, channel);
    const auto tick = first_difference(of_got, of_want);
    if (!tick) continue;
    const bool yes = of_got[*tick] == State::yes;
    EventDifference found{*tick, index,
                          fmt::format("{} is {}, expected {} within a tick", channel.name.substr(4),
                                      yes ? kind.yes : kind.no, yes ? kind.no : kind.yes)};
    if (!first || is_before(found, *first)) first = std::move(found);
  }
  return first;
}

}  // namespace attest
