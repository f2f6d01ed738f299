// Judges a port on one case at one rate, on one flight, or on one recorded trace. The port may run
// in a process of its own (port_host.hpp).
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "harness/casefile/case.hpp"
#include "harness/compare/tolerance.hpp"
#include "harness/golden/golden.hpp"
#include "harness/host/port_host.hpp"
#include "harness/loop/flight.hpp"
#include "harness/loop/open_loop.hpp"
#include "harness/plant/plant.hpp"
#include "harness/trace/trace_parts.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

struct JudgeOptions {
  Level level = Level::numeric;            // of flights, events means numeric
  std::filesystem::path save_traces = {};  // the folder of save_traces(); empty: not saved
  // Replace the parameters of each open-loop case whose module and profile have them. The expected
  // outputs are then those of the reference, which must agree with the golden of the unchanged
  // case.
  std::vector<ParameterChange> parameters = {};
  // Topics that the port never publishes are not compared. The caller decides about them when all
  // vectors were judged (settle_silent_topics).
  bool leaves_out_silent = false;
  // A case that has no golden is judged by the reference alone (VectorResult::no_golden).
  bool by_reference = false;
};

// A result that names its vector, or the file of a recorded trace; the other members have their
// defaults.
VectorResult result_for(const Case& the_case, const RunConfiguration& configuration);
VectorResult result_for(const std::string& recorded, const std::string& profile);

// Generates the case's inputs at that rate, gives them to a fresh unit, and compares the outputs
// with the golden. Errors: the golden is missing, or is not that of this case; the reference does
// not agree with the golden, if the inputs must be changed for the port or by `options`.
Result<VectorResult> evaluate_case(const Case& the_case, const Rate& rate, const Golden& golden,
                                   PortHost& host, const JudgeOptions& options);

// Flies a fresh unit. Compares each output with that of the reference for the same inputs, the
// flight with the golden up to the golden's horizon, and the metrics with their bounds and the
// golden's values. Only the outputs are compared at the level exact, because the results of a plant
// differ in the last bits between processors. REQUIRES: the host's course is this case with this
// vehicle model. Errors: those of evaluate_case(); the flight cannot be set up.
Result<VectorResult> evaluate_flight(const Case& the_case, const RunConfiguration& configuration,
                                     const VehicleModel& vehicle_model, const Golden& golden,
                                     PortHost& host, const JudgeOptions& options = {});

// The same at recorded times, for which no golden exists. The flight of the
// reference at the same times takes the place of the golden. A bound that the reference violates in
// that flight is not applied. Errors: the flight cannot be set up; the reference loses the vehicle
// at these times.
Result<VectorResult> evaluate_timed_flight(const Case& the_case,
                                           const RunConfiguration& configuration,
                                           const VehicleModel& vehicle_model,
                                           const FlightTiming& timing, PortHost& host,
                                           const JudgeOptions& options = {});

// If an output is wrong, adds to the reason the last line that the port printed, if there is one.
void add_last_words(const PortHost& host, VectorResult& result);

// "the flight ended at 0.412 s (tick 103): the body rate is 81 rad/s, beyond 80". REQUIRES:
// Flown::divergence is set.
std::string how_it_ended(const Flown& flown);

// Gives the recorded inputs to a fresh instance of the subject's module, and compares the outputs
// with the recorded ones. `got`, unless null, becomes the trace with the port's outputs, up to the
// fault if there was one. If a fixed step of the port excludes the trace, `got` does not change.
VectorResult evaluate_trace(const Trace& recorded, const ModuleUnderTest& subject, PortHost& host,
                            const Tolerances& tolerances, Trace* got = nullptr);

// The same, in memory that does not grow with the length of the trace: at most `most_ticks` are in
// memory. But the events level, which looks ahead, and a recorded port need the whole trace. For a
// port with a fixed step or in fixed point, the trace is read twice. Errors: those of TraceParts.
Result<VectorResult> evaluate_parts(TraceParts& recorded, const ModuleUnderTest& subject,
                                    PortHost& host, const Tolerances& tolerances,
                                    std::size_t most_ticks = ticks_at_once);

}  // namespace attest
