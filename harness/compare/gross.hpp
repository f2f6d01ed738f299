// Values at the events level: a port need not be near the reference there, but not of another sign
// or size either.
//
// A port that is right at this level is a tick late, or computes in coarse numbers. Its answer at a
// tick is therefore near those of the reference from the tick before to the tick after. With `low`
// and `high`, the least and the largest of these three, it has to be in
//
//     low - slack .. high + slack,   slack = floor + (high - low) + max(|low|, |high|) / 2
//
// - (high - low) once more: one input may reach the port a tick later than another.
// - Half the size: a gain, a filter or a table may be that coarse. An inverted sign and twice the
//   value are outside.
// - floor: 0.1 rad/s for rates setpoints, 0.05 for controls and thrust, 0.02 for integrals. Of a
//   right controller in fixed point these let pass every case that its events let pass with 14 bits
//   behind the point, and all but 2 of 451 with 11 bits.
//
// No value is compared where the port need not be at the same point yet: at the first and the last
// tick, where the topic is not published at one of the three ticks, and within 11 deg of a half
// turn between attitude and setpoint, where a last bit decides which way the law turns.
#pragma once

#include <optional>

#include "harness/compare/events.hpp"

namespace attest {

// The first value outside of that. REQUIRES: as many ticks in both.
std::optional<EventDifference> first_gross_difference(const Trace& got, const Trace& want);

// The first NaN or Inf where `want` has neither, at that tick, the one before and the one after it.
// REQUIRES: as above.
std::optional<EventDifference> first_non_finite_event(const Trace& got, const Trace& want);

}  // namespace attest
