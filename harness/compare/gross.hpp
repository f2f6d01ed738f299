// Values at the events level: a port may deviate from the reference, but by at most about half the
// value plus a small floor.
//
// A port that passes at this level may be a tick late, or compute with coarse numbers. Its output
// at a tick is therefore near the reference's outputs from the tick before to the tick after. With
// `low` and `high`, the least and the largest of these three, the output must be in
//
//     low - slack .. high + slack,   slack = floor + (high - low) + max(|low|, |high|) / 2
//
// - (high - low): it is added to both bounds, because one input may reach the port a tick later
//   than another.
// - Half the size: a gain, a filter or a table may be that coarse. An inverted sign and twice the
//   value are outside, if the value is well above the floor.
// - floor: 0.1 rad/s for rates setpoints and yaw rates, 0.02 for integrals, 0.05 for all other
//   values. With this floor, a correct controller in fixed point with 14 fraction bits passes the
//   value check in every case whose events agree. With 11 bits it fails in 2 of 451.
//
// These bounds are not applied (NaN and infinity are judged at every tick)
// - at the first and the last tick
// - where the reference, at one of the three ticks, does not publish the topic, or has NaN or
//   infinity; also where the port does not publish the topic at this tick
// - where, at one of the three ticks, the law controls the attitude, and one of these holds: the
//   rotation between attitude and setpoint is within 11 deg of a half turn, so that a last bit
//   decides the direction in which the law turns; or attitude or setpoint is zero or not finite.
#pragma once

#include <optional>

#include "harness/compare/events.hpp"

namespace attest {

// The first value outside these bounds. REQUIRES: both have the same number of ticks.
std::optional<EventDifference> first_gross_difference(const Trace& got, const Trace& want);

// Tolerances of about these bounds, for values of the same tick only: max(floor, |want| / 2).
Tolerances gross_tolerances();

// The first NaN or Inf of `got` where `want` is finite at that tick, the tick before and the tick
// after. REQUIRES: both have the same number of ticks.
std::optional<EventDifference> first_non_finite_event(const Trace& got, const Trace& want);

}  // namespace attest
