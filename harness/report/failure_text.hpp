// The text about a failing result, shared by the terminal and JUnit. The reader of a CI log may
// have no other file. So the text has the error, the first deviation, the stage of the law to look
// at, and the command that runs this vector again.
#pragma once

#include <string>

#include "harness/verify/run_result.hpp"

namespace attest {

// One line, without the id: "outputs differ; first at tick 17: out/... got -1.5, want -1".
std::string failure_headline(const VectorResult& result);

// Several lines, the first of which is the id; no newline at the end. `run` gives the port and the
// level for the command that reproduces the failure.
std::string failure_text(const VectorResult& result, const RunResult& run);

// The first deviation, the stage of the law to look at, the worst deviation and the number of
// deviating ticks, without id and commands: for traces outside the suite. Empty if the result has
// no deviation. `inputs_differ`: those of got and want, up to the first deviation; then no stage is
// named, because other inputs make other outputs in the same law.
std::string finding_text(const VectorResult& result, Level level, bool inputs_differ = false);

// "tick 412, in out/...: off by 0.3, 1500 times the tolerance". The worst deviation; empty if that
// is the first deviation, or unknown.
std::string worst_text(const VectorResult& result);

// "rate law or the integrator", of Deviation::stages. "flight as a whole" of the input: each output
// is right for its input, which differs from the golden's.
std::string stages_text(const StageSet& stages);

// "at most 1.2", "at least 0", "0 to 3".
std::string metric_bounds(const MetricResult& metric);

// "attest run --port lib:./mine.so --filter 'px4-v1.5.5/attitude/roll_30@250hz'". Also selects the
// vectors VectorResult::after, without which the vector may pass.
std::string reproduce_command(const VectorResult& result, const RunResult& run);

// The command that writes the trace of a flight. REQUIRES: a plant configuration.
std::string sim_command(const VectorResult& result, const RunResult& run);

// The reason on one line; without a reason, the meaning of the verdict.
std::string reason_text(const VectorResult& result);

// "out/vehicle_rates_setpoint.roll [rad/s]"
std::string channel_with_unit(const Channel& channel);

// "-6.7663884 0xc0d88641": the shortest decimal that reads back as the same value, and the bits.
// Without the bits for a flag.
std::string value_text(const Channel& channel, double value);

// "off by 8.71 (2161195450 ulp), allowed 0.000201: 43273 times the tolerance". Empty for flags,
// which have no distance, and at the level `events`.
std::string distance_text(const Deviation& deviation, Level level);

}  // namespace attest
