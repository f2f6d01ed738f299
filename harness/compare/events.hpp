// Compares the events of traces instead of their values. For ports that are a tick late, or compute
// with coarse numbers.
//
// Events are the changes of states of outputs; the table in events.cpp has those of each module.
// States:
// - All units: a topic is published; a rates setpoint is finite.
// - Controller: an integral moves; |control| of roll, pitch or yaw is larger than the thrust
//   control.
// - Attitude unit and rate unit: the thrust is finite.
// - Rate unit: an integral rises; an integral falls. Landing, a saturation flag, disarming or a
//   limit stops an integral.
// Where a value is too near to the threshold of a state, both states are accepted.
#pragma once

#include <optional>
#include <string>

#include "harness/compare/compare.hpp"

namespace attest {

struct EventDifference {
  std::size_t tick = 0;
  std::size_t channel = 0;
  std::string what;  // "mc_att_ctrl_status.yaw_rate_integ is moving, expected still within a tick"
};

// Orders by the tick, at the same tick by the stage of the law.
bool is_before(const EventDifference& a, const EventDifference& b);

// Mixer and battery estimate have no events. They are judged by their values.
bool has_events(Module module);

// True if a channel of `present` defines an event.
bool tells_events(const ChannelSet& present);

// The first tick at which the traces differ: there a state is true, or is false, in one trace, and
// the other trace has the opposite at this tick and at both its neighbours. The first and the last
// tick never differ, because they lack a neighbour. At the same tick the earlier stage is first.
// REQUIRES: as many ticks in both.
std::optional<EventDifference> first_event_difference(const Trace& got, const Trace& want);

}  // namespace attest
