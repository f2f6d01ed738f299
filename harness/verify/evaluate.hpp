// One case at one rate, one flight, or one recorded trace: the verdict on a port, which may run in
// a process of its own (port_host.hpp).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/golden/golden.hpp"
#include "harness/host/port_host.hpp"
#include "harness/loop/flight.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/plant/plant.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

struct JudgeOptions {
  Level level = Level::numeric;            // of open-loop cases
  std::filesystem::path save_traces = {};  // the folder of save_traces(); empty: not saved
  // These replace the parameters of each open-loop case whose module and profile has them. The
  // expected outputs are then those of the reference, which must first agree with the golden.
  std::vector<ParameterChange> parameters = {};
};

// The identity of a result, before there is a verdict.
CaseResult result_for(const Case& the_case, const RunConfiguration& configuration);
CaseResult result_for(const Trace& recorded, const std::string& profile);

// Generates the case's inputs at that rate, gives them to a fresh unit, and compares the outputs
// with the golden. Errors are those of the environment: a golden that is missing or stale.
// `saved_traces` below is the folder of save_traces(); empty: not saved.
Result<CaseResult> evaluate_case(const Case& the_case, const Rate& rate, const Golden& golden,
                                 PortHost& host, const JudgeOptions& options);

// A fresh unit flies. REQUIRES: the host's course is this case with this vehicle model. Each output
// is compared with that of the reference for the same inputs. The flight is compared with the
// golden up to the golden's horizon, and the metrics with their bounds. The level is numeric in
// every run: a plant's results differ in the last bits between processors, so no flight is compared
// to the bit. Errors: as above.
Result<CaseResult> evaluate_flight(const Case& the_case, const RunConfiguration& configuration,
                                   const VehicleModel& vehicle_model, const Golden& golden,
                                   PortHost& host, const std::filesystem::path& saved_traces = {});

// The same at recorded times. These have no golden: the reference flies at the same times for
// comparison. A bound that the reference violates at these times is not applied. Errors: the flight
// cannot be set up; the reference loses the vehicle at these times.
Result<CaseResult> evaluate_timed_flight(const Case& the_case,
                                         const RunConfiguration& configuration,
                                         const VehicleModel& vehicle_model,
                                         const FlightTiming& timing, PortHost& host,
                                         const std::filesystem::path& saved_traces = {});

// "the flight ended at 0.412 s (tick 103): the body rate is 81 rad/s, beyond 80". REQUIRES: a
// divergence.
std::string how_it_ended(const Flown& flown);

// Gives the recorded inputs to a fresh instance of that module of the port, and compares the
// outputs with the recorded ones. `got`, unless null, becomes the trace with the port's outputs, up
// to the fault if there was one.
CaseResult evaluate_trace(const Trace& recorded, const Subject& subject, PortHost& host,
                          const Tolerances& tolerances, Trace* got = nullptr);

}  // namespace attest
