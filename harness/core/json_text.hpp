// JSON as text. Bytes that are not UTF-8 are replaced by U+FFFD, so that every text is accepted:
// the texts of a port may have any bytes.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace attest {

std::string text_of(const nlohmann::json& value);              // one line, without its end
std::string document_of(const nlohmann::ordered_json& value);  // indented, for a file

}  // namespace attest
