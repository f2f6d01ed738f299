// A StressResult as JSON and back: for the message of a stress run's child, and for an entry of the
// JSON report. The measured times are integer nanoseconds under keys that end in _ns.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "harness/core/result.hpp"
#include "harness/measure/stress.hpp"

namespace attest {

nlohmann::json to_json(const StressResult& stress);

// The inverse of to_json(), without `timeline` and `cyclictest`. Errors: a missing or wrong member,
// which a port can cause because it shares the child's process.
Result<StressResult> stress_from_json(const nlohmann::json& json);

}  // namespace attest
