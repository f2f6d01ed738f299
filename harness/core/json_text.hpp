// JSON as text. A port chooses its words, which may not be UTF-8: bytes that are not are replaced
// by U+FFFD, so that no text is refused.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace attest {

std::string text_of(const nlohmann::json& value);              // one line, without its end
std::string document_of(const nlohmann::ordered_json& value);  // indented, for a file

}  // namespace attest
