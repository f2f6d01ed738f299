#include "harness/compare/events.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include <fmt/format.h>

namespace attest {
namespace {

enum class State { no, yes, unclear };

// A property of one output, such as `published`: yes, no or unclear at each tick.
struct Kind {
  const char* channel;
  State (*at)(const Trace& trace, std::size_t tick, const Channel& channel);
  const char* yes;  // the text for messages
  const char* no;
};

State published(const Trace& trace, std::size_t tick, const Channel& channel) {
  return value_of(channel, trace.samples[tick]) != 0 ? State::yes : State::no;
}

State finite(const Trace& trace, std::size_t tick, const Channel& channel) {
  if (trace.samples[tick].out.vehicle_rates_setpoint.published == 0) return State::unclear;
  return std::isfinite(float_of(channel, trace.samples[tick])) ? State::yes : State::no;
}

// An integral moves if its step is above a fraction of the integrals' tolerance. That tolerance is
// the total deviation allowed over the run.
State moving(const Trace& trace, std::size_t tick, const Channel& channel) {
  constexpr double still = 1e-6, surely = 4e-6;
  const auto is_published = [&](std::size_t at) {
    return trace.samples[at].out.mc_att_ctrl_status.published != 0;
  };
  if (tick == 0 || !is_published(tick) || !is_published(tick - 1)) return State::unclear;
  const double step = std::abs(static_cast<double>(float_of(channel, trace.samples[tick])) -
                               static_cast<double>(float_of(channel, trace.samples[tick - 1])));
  if (step > surely) return State::yes;
  return step < still ? State::no : State::unclear;
}

State beyond_thrust(const Trace& trace, std::size_t tick, const Channel& channel) {
  constexpr double near = 1e-3;
  const Sample& sample = trace.samples[tick];
  if (sample.out.actuator_controls_0.published == 0) return State::unclear;
  const double over = std::abs(static_cast<double>(float_of(channel, sample))) -
                      static_cast<double>(sample.out.actuator_controls_0.control[3]);
  if (std::abs(over) < near) return State::unclear;
  return over > 0 ? State::yes : State::no;
}

constexpr Kind kinds[] = {
    {"out/vehicle_rates_setpoint.published", published, "published", "not published"},
    {"out/actuator_controls_0.published", published, "published", "not published"},
    {"out/mc_att_ctrl_status.published", published, "published", "not published"},
    {"out/vehicle_rates_setpoint.roll", finite, "finite", "not finite"},
    {"out/vehicle_rates_setpoint.pitch", finite, "finite", "not finite"},
    {"out/vehicle_rates_setpoint.yaw", finite, "finite", "not finite"},
    {"out/actuator_controls_0.control[0]", beyond_thrust, "beyond the thrust", "within it"},
    {"out/actuator_controls_0.control[1]", beyond_thrust, "beyond the thrust", "within it"},
    {"out/actuator_controls_0.control[2]", beyond_thrust, "beyond the thrust", "within it"},
    {"out/mc_att_ctrl_status.roll_rate_integ", moving, "moving", "still"},
    {"out/mc_att_ctrl_status.pitch_rate_integ", moving, "moving", "still"},
    {"out/mc_att_ctrl_status.yaw_rate_integ", moving, "moving", "still"},
};

std::size_t channel_of(const Kind& kind) {
  return *find_channel(Module::mc_att_control, kind.channel);
}

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

bool tells_events(const ChannelSet& present) {
  return std::any_of(std::begin(kinds), std::end(kinds),
                     [&](const Kind& kind) { return present[channel_of(kind)]; });
}

std::optional<EventDifference> first_event_difference(const Trace& got, const Trace& want) {
  std::optional<EventDifference> first;
  for (const Kind& kind : kinds) {
    const std::size_t index = channel_of(kind);
    if (!want.present[index]) continue;
    const Channel& channel = channels()[index];
    const auto of_got = states(kind, got, channel), of_want = states(kind, want, channel);
    const auto tick = first_difference(of_got, of_want);
    if (!tick || (first && first->tick <= *tick)) continue;
    const bool yes = of_got[*tick] == State::yes;
    first =
        EventDifference{*tick, index,
                        fmt::format("{} is {}, expected {} within a tick", channel.name.substr(4),
                                    yes ? kind.yes : kind.no, yes ? kind.no : kind.yes)};
  }
  return first;
}

}  // namespace attest
