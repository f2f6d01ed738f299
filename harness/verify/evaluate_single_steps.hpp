// Compares a port with the single steps of a log (ulog/single_steps.hpp).
#pragma once

#include <cstddef>
#include <string>

#include "harness/verify/evaluate_log.hpp"
#include "harness/verify/replayed_log.hpp"

namespace attest {

// For a verdict. Fewer steps may agree by chance.
inline constexpr std::size_t least_steps = 20;

// Gives the single steps to the port and to the reference, and compares both with the log. Steps
// with a setpoint older than the reference agrees with are left out. If the reference does not
// agree at any age, another law flew, and nothing is judged. The steps with
// the unit's own setpoint and the others are judged apart: TopicAgreement::condition tells which.
//
// The torque is compared without its integral, which comes from the log (integral_in_use.hpp).
// Where the yaw torque is filtered (v1.16 and later), it is not compared.
//
// Sets topics, single_steps and ticks of `found`; the verdict if the port has a fault; the traces
// if `keeps_traces`. REQUIRES: LoggedUnit::single_steps. Errors: those of LoggedTicks::next_part().
Result<void> compare_single_steps(const LoggedUnit& steps, const ModuleUnderTest& subject,
                                  PortHost& port, const LogLimits& limits,
                                  const LogParameters& parameters, std::size_t most_ticks,
                                  bool keeps_traces, const OpenHost& reference, LogResult& found);

}  // namespace attest
