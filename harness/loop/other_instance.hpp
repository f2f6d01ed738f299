// What another instance is given while or before the judged one runs (Instances). It must differ
// from what the judged one is given in every topic and every parameter: a variable that the two
// share then has a wrong value in the judged one.
#pragma once

#include <string>
#include <vector>

#include "harness/trace/trace.hpp"

namespace attest {

// The ticks of `judged` for another instance:
//
//     every topic and parameter_update are new at every tick, so each tick overwrites what is
//     shared; numbers and times differ from those of the judged instance at the same tick; flags
//     are inverted at every even tick, and equal at the others, so that the other instance also
//     goes through the judged one's stages of the law and changes their state; parameters that
//     `judged` sets have other values, from the same tick on.
Trace other_inputs(Trace judged, Module module, const std::string& profile);

// Other values of all parameters that `judged` leaves at their default at tick 0. Empty for an
// unknown profile. The port may refuse them: it need not have the parameters of a feature that it
// does not support.
std::vector<ParameterChange> other_defaults(const Trace& judged, Module module,
                                            const std::string& profile);

}  // namespace attest
