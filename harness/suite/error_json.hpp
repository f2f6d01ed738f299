// An Error as JSON and back: {"message": ..., "file": ..., "line": 12, "column": 3}, empty and 0
// where unknown.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "harness/core/result.hpp"

namespace attest {

nlohmann::json to_json(const Error& error);

// Errors: no object, or one without a message.
Result<Error> error_from_json(const nlohmann::json& json);

}  // namespace attest
