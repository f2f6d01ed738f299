// Traces as logs of PX4, for the tools that show flights.
#pragma once

#include <filesystem>

#include "harness/core/result.hpp"
#include "harness/trace/trace.hpp"

namespace attest {

// Writes a trace with all its columns to a file that appears when it is complete: a ULog if the
// name ends with .ulg, else CSV.
//
// In the ULog, topics and fields have the names of the columns, which are PX4's. A topic is logged
// at the ticks at which it is new: control_state and the state of the vehicle at every tick, other
// inputs when they are updated, outputs when they are published. The instance 0 of
// vehicle_rates_setpoint is the unit's own, the instance 1 that of others. Parameters are logged
// with their first values, and again when they change. Errors: the file cannot be written; a ULog
// of a mixer or battery estimate.
Result<void> write_trace(const std::filesystem::path& path, const Trace& trace);

}  // namespace attest
