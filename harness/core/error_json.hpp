// Converts an Error to JSON and back: {"message": ..., "file": ..., "line": 12, "column": 3}. When
// it is read, a missing `file` becomes empty, a missing `line` or `column` 0. Converts a value or
// an error to text: {"result": ...} or {"error": {...}}.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "harness/core/result.hpp"

namespace attest {

nlohmann::json to_json(const Error& error);

// Errors: not an object, or an object without a message.
Result<Error> error_from_json(const nlohmann::json& json);

// Bytes that are not UTF-8 are replaced by U+FFFD.
std::string encode(const Result<nlohmann::json>& result);

// The inverse of encode(). Errors: the error that was encoded; text that is neither a result nor an
// error.
Result<nlohmann::json> decode(const std::string& text);

}  // namespace attest
