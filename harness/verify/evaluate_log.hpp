// A port against the log of a real flight.
#pragma once

#include <vector>

#include "harness/compare/log_agreement.hpp"
#include "harness/host/port_host.hpp"
#include "harness/ulog/flight_log.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

struct LogResult {
  CaseResult result;  // verdict and reason
  std::vector<TopicAgreement> topics;
  Trace got;  // the port's outputs; up to the fault, if there was one
};

// Gives the inputs of one unit of a log to a fresh instance and compares its outputs with the
// logged ones.
//
// - The attitude law's rates setpoint depends on one sample only. It is judged in every log, except
//   at ticks for which the log lacks an input.
// - All other outputs depend on earlier steps. They are judged if the log has every step; in a log
//   of v1.14 to v1.16 also if it has nearly every step.
// - In a log of v1.14 to v1.16, and in one of the controller that lacks steps, the reference must
//   also agree with the log; otherwise the output is not judged. The log then lacks samples (the
//   logger also thins inputs such as control_allocator_status), or another law flew.
// - If attest does not have the profile, no reference checks the log: its outputs are taken as
// right.
// - NaN or infinity where the log has a number is judged in every output (Verdict::non_finite).
//
// If no output is judged, the verdict is skip. `parameters` replace those of the log for the port;
// the reference has them only where the log has none of that name. Parameters that the unit does
// not have in this profile are left out. The verdict is never a statement of conformance: a log
// shows few situations.
LogResult evaluate_log(const LoggedUnit& log, const std::string& profile, PortHost& host,
                       const LogLimits& limits,
                       const std::vector<ParameterChange>& parameters = {});

}  // namespace attest
