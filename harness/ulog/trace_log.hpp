// Writes traces as logs of PX4, for the tools that show flights.
#pragma once

#include "harness/core/file.hpp"
#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Writes a trace with all its columns to a ULog that appears when it is complete.
//
// Topics and fields have the names of log_topics.hpp, which are PX4's. `timestamp` is
// the time of the step in every topic. A topic is logged at the ticks at which it is new: the topic
// that triggers the step (control_state, vehicle_attitude, vehicle_angular_velocity) and the true
// state of the vehicle at every tick, other inputs when they are updated, outputs when they are
// published. If the module reads and publishes a topic, its own samples are in instance 0, those of
// other modules in instance 1. Parameters are logged with their first values, and again when they
// change. Errors: the file cannot be written; a trace of a mixer or battery estimate.
Result<void> write_log(AtomicFile file, const Trace& trace);

}  // namespace attest
