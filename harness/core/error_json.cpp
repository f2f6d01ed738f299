#include "harness/core/error_json.hpp"

#include <utility>

#include <nlohmann/json.hpp>

#include "harness/core/json_text.hpp"

namespace attest {
namespace {

int whole_number(const nlohmann::json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number_integer() ? found->get<int>() : 0;
}

std::string words(const nlohmann::json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

}  // namespace

nlohmann::json to_json(const Error& error) {
  return {{"message", error.message},
          {"file", error.file},
          {"line", error.line},
          {"column", error.column}};
}

Result<Error> error_from_json(const nlohmann::json& json) {
  if (!json.is_object() || words(json, "message").empty()) {
    return fail("a process reported an error without a message");
  }
  return Error{words(json, "message"), words(json, "file"), whole_number(json, "line"),
               whole_number(json, "column")};
}

std::string encode(const Result<nlohmann::json>& result) {
  const nlohmann::json text = result ? nlohmann::json{{"result", *result}}
                                     : nlohmann::json{{"error", to_json(result.error())}};
  return text_of(text);
}

Result<nlohmann::json> decode(const std::string& text) {
  nlohmann::json json = json_from(text);
  if (json.is_object() && json.contains("result")) return std::move(json["result"]);
  if (json.is_object() && json.contains("error")) {
    auto error = error_from_json(json["error"]);
    return tl::unexpected(error ? *std::move(error) : error.error());
  }
  return fail("a process sent what is neither a result nor an error");
}

}  // namespace attest
