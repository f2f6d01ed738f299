// The plots of one flight as JSON, for the script of its page.
#pragma once

#include <string>

#include "harness/trace/trace.hpp"

namespace attest {

// Signals have the names of their columns in the flown trace:
//
//     {"plots": [{"title": "Body rates", "unit": "rad/s", "tick": "...", "time": "...",
//                 "series": [{"name": "plant/vehicle_attitude.rollspeed", "values": "..."}]}],
//      "replay": {"time": "...", "attitude": ["...", "...", "...", "..."], "setpoint": [...]}}
//
// The texts "..." are base64 of float32; time is in seconds from the first tick. A plot has the
// ticks of extreme_ticks(). The replay has the quaternions of evenly spaced ticks. `<` is escaped.
// REQUIRES: a flown trace with at least one tick.
std::string flight_plots_json(const Trace& flown);

}  // namespace attest
