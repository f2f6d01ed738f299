// A StressResult as JSON and back: the message of a stress run's child, and one entry of the JSON
// report. Times are integer nanoseconds, their keys end in _ns.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "harness/core/result.hpp"
#include "harness/measure/stress.hpp"

namespace attest {

nlohmann::json to_json(const StressResult& stress);

// Errors: a missing or wrong member, which the port can cause because it shares the child's
// process.
Result<StressResult> stress_from_json(const nlohmann::json& json);

}  // namespace attest
