// JSON from and to text. The parser of nlohmann_json takes seconds to compile, so only
// json_text.cpp uses it.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "harness/core/result.hpp"

namespace attest {

// For text of a user or a port. Errors, with `file` and the place in it: the text is not JSON, or
// was cut off; an object has a key twice.
Result<nlohmann::json> parse_json(std::string_view text, const std::string& file);

// For text of attest's own processes. If it is not JSON, returns a discarded value
// (is_discarded()), which is not an object.
nlohmann::json json_from(std::string_view text);
nlohmann::ordered_json ordered_json_from(std::string_view text);  // keeps the order of the keys

// Bytes that are not UTF-8 are replaced by U+FFFD, because the texts of a port may have any bytes.
std::string text_of(const nlohmann::json& value);              // one line, without a newline
std::string document_of(const nlohmann::ordered_json& value);  // indented, for a file

}  // namespace attest
