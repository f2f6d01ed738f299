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

// Gives the log's inputs to a fresh unit and compares its outputs with the logged ones. A rates
// setpoint depends on one sample only, so it is judged in every log. Outputs that depend on earlier
// steps are judged if the log has every step. NaN or infinity where the log has a number is judged
// in every output (Verdict::non_finite). Parameters that the profile does not have are left out.
// The verdict is never a statement of conformance: a log shows few situations.
LogResult evaluate_log(const FlightLog& log, const std::string& profile, PortHost& host,
                       const LogLimits& limits);

}  // namespace attest
