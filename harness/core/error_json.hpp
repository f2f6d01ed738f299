// An Error as JSON and back: {"message": ..., "file": ..., "line": 12, "column": 3}, empty and 0
// where unknown. And a value or an error as text: {"result": ...} or {"error": {...}}.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "harness/core/result.hpp"

namespace attest {

nlohmann::json to_json(const Error& error);

// Errors: no object, or one without a message.
Result<Error> error_from_json(const nlohmann::json& json);

// Text that is not UTF-8 is repaired with U+FFFD.
std::string encode(const Result<nlohmann::json>& result);

// The inverse. Errors: the one that was encoded, or that it is neither.
Result<nlohmann::json> decode(const std::string& text);

}  // namespace attest
