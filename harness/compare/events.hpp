// Compares the events of traces instead of their values. For ports that are a tick late, or compute
// with coarse numbers.
//
// Events are the changes of these states: a topic is published; an integral moves; the control of
// roll, pitch or yaw is larger than that of thrust, in absolute value; a rates setpoint is finite.
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

// Only the controller has events. Mixer and battery estimate are judged by their values.
inline bool has_events(Module module) { return module == Module::mc_att_control; }

// True if a channel of `present` defines an event.
bool tells_events(const ChannelSet& present);

// The first tick at which only one of the traces is in a state: the other is not in it at that
// tick, the tick before or the tick after. REQUIRES: as many ticks in both.
std::optional<EventDifference> first_event_difference(const Trace& got, const Trace& want);

}  // namespace attest
