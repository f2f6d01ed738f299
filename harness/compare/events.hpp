// What happens in a trace, rather than what its values are: for ports that are the same controller
// a tick later, or in coarser numbers.
//
// Events are the changes of these states: a topic is published; an integral moves; a control
// exceeds the thrust; a rates setpoint is finite. Where a value is too near to the edge of a state
// to say, nothing is expected.
#pragma once

#include <optional>
#include <string>

#include "harness/compare/compare.hpp"

namespace attest {

struct EventDifference {
  std::size_t tick = 0;
  std::size_t channel = 0;
  std::string what;  // "the integral moves, expected still"
};

// A mixer and a battery estimate are judged by their values.
inline bool has_events(Module module) { return module == Module::mc_att_control; }

// Is there a channel that an event is told from?
bool tells_events(const ChannelSet& present);

// The first tick at which `got` is in a state that `want` is in neither at that tick, nor the one
// before or after it, or the other way round. REQUIRES: as many ticks in both.
std::optional<EventDifference> first_event_difference(const Trace& got, const Trace& want);

}  // namespace attest
