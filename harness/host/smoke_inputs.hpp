// The inputs of `smoke`, for a unit of any module.
#pragma once

#include <string>
#include <vector>

#include "harness/core/rate.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// The inputs of a vehicle that hovers and shakes, for `steps` steps. All topics are new at the
// first step, later only those that are new in every step. REQUIRES: a module with updated bits.
Trace shaken_vehicle(Module module, const Rate& rate, std::size_t steps);

// The same with NaN and infinity in the floats of every topic that is new in each step.
Trace without_numbers(Trace trace, Module module);

// The topics that a unit of the module must publish with these inputs, and the name of a parameter
// that it has.
std::vector<std::string> expected_topics(Module module);
std::string known_parameter(Module module);

}  // namespace attest
