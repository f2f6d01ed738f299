#include "harness/core/json_text.hpp"

#include <nlohmann/json.hpp>

namespace attest {
namespace {

constexpr auto repair = nlohmann::json::error_handler_t::replace;

}  // namespace

nlohmann::json json_from(std::string_view text) {
  return nlohmann::json::parse(text, nullptr, false);
}

std::string text_of(const nlohmann::json& value) { return value.dump(-1, ' ', false, repair); }

std::string document_of(const nlohmann::ordered_json& value) {
  return value.dump(2, ' ', false, repair) + "\n";
}

}  // namespace attest
