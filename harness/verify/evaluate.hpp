// One case at one rate, one flight, or one recorded trace: the verdict on a port, which may run in
// a process of its own (port_host.hpp).
#pragma once

#include <filesystem>
#include <string>

#include "harness/casefile/case.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/golden/golden.hpp"
#include "harness/host/port_host.hpp"
#include "harness/loop/flight.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/plant/plant.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// The identity of a result, before there is a verdict.
CaseResult result_for(const Case& the_case, const RunConfiguration& configuration);
CaseResult result_for(const Trace& recorded, const std::string& profile);

// The case's inputs at that rate are made anew, given to a fresh unit, and what it answers is
// compared with the golden. Errors are the environment's: a golden that is missing or stale.
Result<CaseResult> evaluate_case(const Case& the_case, const Rate& rate, const Golden& golden,
                                 PortHost& host, Level level);

// A fresh unit flies. REQUIRES: the host's course is this case with this vehicle model. Each answer
// is compared with that of the reference to the same inputs, the flight with the golden up to the
// golden's horizon, and its metrics with their bounds. The level is the same for every run: what a
// plant computes differs in the last bits between processors, so no flight is compared to the bit.
// Errors: as above.
Result<CaseResult> evaluate_flight(const Case& the_case, const RunConfiguration& configuration,
                                   const VehicleModel& vehicle_model, const Golden& golden,
                                   PortHost& host);

// The same at recorded times, for which there is no golden: beside the reference, flown at the same
// times. A bound of the case's metrics that the reference misses at these times binds no port.
// Errors: the flight cannot be set up; the reference loses the vehicle at these times.
Result<CaseResult> evaluate_timed_flight(const Case& the_case,
                                         const RunConfiguration& configuration,
                                         const VehicleModel& vehicle_model,
                                         const LoopTiming& timing, PortHost& host);

// "the flight ended at 0.412 s (tick 103): the body rate is 81 rad/s, beyond 80". REQUIRES: a
// divergence.
std::string how_it_ended(const Flown& flown);

// The recorded inputs are given to a fresh instance of that module of the port, and what it answers
// is compared with the recorded outputs.
CaseResult evaluate_trace(const Trace& recorded, const Subject& subject, PortHost& host,
                          const Tolerances& tolerances);

}  // namespace attest
