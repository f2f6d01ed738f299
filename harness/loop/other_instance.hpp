// The inputs of another instance of the port, which runs before or while the judged one runs
// (Instances in case.hpp). They differ from the judged one's in every topic and parameter. So if
// both instances share a variable, it has a wrong value in the judged one.
#pragma once

#include <string>
#include <vector>

#include "harness/trace/trace.hpp"

namespace attest {

// The ticks of `judged`, changed for another instance:
//
// - Every topic and parameter_update are new at every tick, so each tick overwrites what is shared.
// - Times are 1 ms later. Numbers are changed by a rule for each quantity, so that their absolute
//   values differ too.
// - Flags are inverted at every even tick and equal at the others. So the other instance also runs
//   the judged one's stages of the law, and changes their state.
// - Parameters that `judged` sets are set to other values, at the same ticks.
Trace other_inputs(Trace judged, Module module, const std::string& profile);

// Other values of all parameters that `judged` does not set at tick 0. Empty for an unknown
// profile. The port may refuse them: it need not have the parameters of a feature that it does not
// support.
std::vector<ParameterChange> other_defaults(const Trace& judged, Module module,
                                            const std::string& profile);

}  // namespace attest
