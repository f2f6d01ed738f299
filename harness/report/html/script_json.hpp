// JSON as the content of a <script> element.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace attest {

// The JSON on one line. "</script" and "<!--" would end or change the element, so `<` is written as
// \u003c.
std::string script_json(const nlohmann::json& value);

}  // namespace attest
