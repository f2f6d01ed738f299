// Judges a port by the log of a real flight.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "harness/compare/log_agreement.hpp"
#include "harness/host/port_host.hpp"
#include "harness/ulog/flight_log.hpp"
#include "harness/verify/evaluate.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// Opens the port that takes the place of the reference.
using OpenHost = std::function<std::unique_ptr<PortHost>()>;
std::unique_ptr<PortHost> open_the_reference();

struct LogResult {
  VectorResult result;  // verdict and reason
  std::vector<TopicAgreement> topics;
  std::optional<SingleSteps> single_steps;  // if set, only these steps were compared
  // What was compared: the log's outputs, and the port's up to its fault, if there was one. Only
  // for a log that is in memory as a whole; else empty.
  Trace want, got;
};

// Gives the inputs of one unit of a log to a fresh instance and compares its outputs with the
// logged ones. An output is judged if the log shows enough of its inputs:
//
// - vehicle_rates_setpoint of the controller and of the attitude unit depends on one sample only.
//   Ticks for which the log lacks an input are left out. Where the sticks make the setpoint, it
//   depends on earlier steps.
// - Of actuator_controls_0 of the controller, an axis depends on earlier steps only by its D term,
//   by its integral, and in v1.3.4 by its feed-forward. While the reference's integrals are 0, the
//   thrust and the axes without these terms are judged, as a topic of their own.
// - All other outputs depend on earlier steps. The log must have every step; a log of v1.14 to
//   v1.16 may lack a few.
// - The reference must agree with the log, unless the log is of the controller and has every step.
//   If it does not agree, the log lacks samples (the logger also drops samples of inputs such as
//   control_allocator_status), or another law flew.
// - If attest does not have the profile, the log is not compared with the reference.
// - NaN or infinity where the log has a number fails in every output (Verdict::non_finite).
// - If the log of a unit of v1.14 to v1.18 lacks too many steps for all this, its single steps are
//   judged (ulog/single_steps.hpp, evaluate_single_steps.hpp).
//
// If no output is judged, the verdict is skip. The port gets the parameters `given` instead of the
// log's parameters of the same names. The reference gets those of `given` that the log does not
// have. Parameters that the unit does not have in this profile are left out. A log shows few
// situations, so a pass is no statement of conformance.
//
// With another port as the reference, a pass of this port says that it agrees with the log.
//
// Reads the ticks once, and again if they judge nothing; `most_ticks` at once. Errors: those of
// LoggedTicks::next_part().
Result<LogResult> evaluate_log(const LoggedUnit& log, const std::string& profile, PortHost& host,
                               const LogLimits& limits,
                               const std::vector<ParameterChange>& given = {},
                               std::size_t most_ticks = ticks_at_once,
                               const OpenHost& reference = open_the_reference);

}  // namespace attest
