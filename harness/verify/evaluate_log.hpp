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
// - An output that depends on one sample only (the attitude law's rates setpoint) is judged in
//   every log; ticks of which the log does not have all that it depends on are left out.
// - An output that depends on earlier steps is judged if the log has every step; of v1.14 to v1.16
//   also if it has about every step.
// - In a log of v1.14 to v1.16, and in one of the controller without every step, an output is
//   judged only if the reference's agrees with the log. Otherwise the log lacks samples (the logger
//   also thins inputs such as control_allocator_status), or another law flew, and no port can be
//   judged by it. A log of a profile that attest does not have is believed.
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
