// The stages of the law that can contain the mistake behind a first deviation.
#pragma once

#include "harness/trace/channels.hpp"

namespace attest {

// `deviating`: the outputs that deviate in the first step with a deviation; `compared`: those that
// are compared; `want`: the expected sample of that step. The result has:
//   - the stage that writes the first of the deviating outputs, in the order of the stages. For the
//     rates setpoint of the controller that is the stage `sticks` in acro;
//   - the actuators, if that is the rate law and the battery has a scale other than 1;
//   - if it is a stage of the rate loop, the other stages there whose outputs deviate in this step.
//     They share the error, the time step and the resets of the integrals, which are no outputs;
//   - the earlier stages that ran in this step, but without an output that is compared, for example
//     because the controller publishes no controls while the circuit breaker is set.
// All other earlier stages are correct up to this step, or do not run in it. REQUIRES: `deviating`
// has an output.
StageSet suspected_stages(const ChannelSet& deviating, const ChannelSet& compared,
                          const Sample& want);

}  // namespace attest
