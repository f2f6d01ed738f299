#include "harness/report/html/script_json.hpp"

#include <nlohmann/json.hpp>

#include "harness/core/json_text.hpp"

namespace attest {

std::string script_json(const nlohmann::json& value) {
  std::string out;
  for (const char c : text_of(value)) {
    if (c == '<')
      out += "\\u003c";
    else
      out += c;
  }
  return out;
}

}  // namespace attest
