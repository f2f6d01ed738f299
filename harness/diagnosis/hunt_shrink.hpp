// Shrinks the inputs of a trial that failed: fewer ticks, then as many inputs as possible at the
// baseline, while the port fails in the same way.
#pragma once

#include "harness/diagnosis/hunt_generator.hpp"
#include "harness/diagnosis/hunt_trial.hpp"
#include "harness/host/port_process.hpp"

namespace attest {

// The failure of the shrunk inputs.
struct ShrunkTrial {
  HuntInputs inputs;
  VectorResult failure;
};

// `failed`: the result of `inputs`. Errors: the reference fails, or a host cannot be started.
Result<ShrunkTrial> shrink(const HuntTarget& target, HuntInputs inputs, VectorResult failed,
                           const HostOptions& options);

// Whether two failures may have one cause: the same verdict, first in the same output.
bool fail_the_same_way(const VectorResult& one, const VectorResult& other);

}  // namespace attest
