// A hunt of a port that lacks features of the law (Lacks): trials use what it has.
#pragma once

#include "harness/diagnosis/hunt_inputs.hpp"
#include "harness/port/lacks.hpp"

namespace attest {

bool uses_lacking(const Lacks& lacks, const HuntInputs& inputs);

// Puts the baseline in place of inputs and parameters that use a feature which the port lacks, and
// keeps the others. Constants of the port stay.
void leave_out_lacking(const Lacks& lacks, HuntInputs& inputs);

}  // namespace attest
