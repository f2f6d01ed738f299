// JSON from and to text. The parser of nlohmann_json takes seconds to compile, so only
// json_text.cpp uses it.
#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace attest {

// If the text is not JSON, returns a discarded value (is_discarded()), which is not an object.
nlohmann::json json_from(std::string_view text);

// Bytes that are not UTF-8 are replaced by U+FFFD, because the texts of a port may have any bytes.
std::string text_of(const nlohmann::json& value);              // one line, without a newline
std::string document_of(const nlohmann::ordered_json& value);  // indented, for a file

}  // namespace attest
