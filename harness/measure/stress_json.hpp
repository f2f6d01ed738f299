// A StressResult as JSON: an entry of the JSON report. The measured times are integer nanoseconds
// under keys that end in _ns.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "harness/measure/stress.hpp"

namespace attest {

// Without the timeline.
nlohmann::json to_json(const StressResult& stress);

}  // namespace attest
