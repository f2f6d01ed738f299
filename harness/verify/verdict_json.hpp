// A VectorResult as JSON and back: the message of a worker process to the command, and one entry of
// the JSON report.
//
//     {"id": "px4-v1.5.5/attitude/roll_30@250hz", "profile": ..., "group": ..., "name": ...,
//      "rate": "250", "verdict": "fail", "reason": "...", "ticks": 500, "deviating_ticks": 3,
//      "first": {"channel": "out/vehicle_rates_setpoint.roll", "stage": "attitude law", ...},
//      "tightest": {"ratio": 12.3, "tick": 17, "channel": "out/..."}, "elapsed_s": 0.012}
//
// A flight also has "vehicle", "plant" and "metrics", a list of {"name": "settles", "measure":
// "settling_time_s", "value": 0.62, "reference": 0.61, "tolerance": 0.08, "min": "-inf", "max": 1,
// "within": true}. A skip of a case that is compared at the exact level only has "exact_only":
// true.
//
// `first`, `worst` (same members as `first`) and `tightest` are absent when the result has no such
// value. JSON has no NaN and no infinity: a number that is not finite is the string "nan", "inf" or
// "-inf". Channels are given by name. `got` and `want` of a float32 channel have their bits in
// addition to the number.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "harness/core/result.hpp"
#include "harness/verify/verdict.hpp"

namespace attest {

// Text of the port may be invalid UTF-8, which text_of() and document_of() repair.
nlohmann::json to_json(const VectorResult& result);

// The inverse of to_json(). Errors: a discarded value (json_from), a missing or wrong member, an
// unknown verdict, channel or rate; `exact_only` of another verdict than skip. Unknown and derived
// members (id, stage, within) are ignored.
Result<VectorResult> vector_result_from_json(const nlohmann::json& json);

}  // namespace attest
