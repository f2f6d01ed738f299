#include "harness/suite/error_json.hpp"

#include <nlohmann/json.hpp>

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
    return fail("a worker process reported an error without a message");
  }
  return Error{words(json, "message"), words(json, "file"), whole_number(json, "line"),
               whole_number(json, "column")};
}

}  // namespace attest
