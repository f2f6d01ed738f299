// Makes inputs of trials from cases, for a hunt that begins with them.
#pragma once

#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/diagnosis/hunt_inputs.hpp"

namespace attest {

// The inputs of the case at the rate. A case of more than about 1000 ticks is cut into several
// trials: at the first tick of each, the topics are new that were published before it, and the
// parameters have the values of that time. REQUIRES: an open-loop case.
std::vector<HuntInputs> trials_of_case(const Case& the_case, const Rate& rate);

}  // namespace attest
