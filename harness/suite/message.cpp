#include "harness/suite/message.hpp"

#include <nlohmann/json.hpp>

#include "harness/suite/error_json.hpp"
#include "harness/suite/verdict_json.hpp"

namespace attest {
namespace {

using nlohmann::json;

struct ToJson {
  json operator()(const TaskBegins& begins) const { return {{"begin", begins.task}}; }
  json operator()(const CaseResult& result) const { return {{"result", to_json(result)}}; }
  json operator()(const Error& error) const { return {{"error", to_json(error)}}; }
  json operator()(const BatchDone&) const { return {{"done", true}}; }
};

}  // namespace

std::string encode(const Message& message) {
  // Words of a port may not be UTF-8: they are repaired, not refused.
  return std::visit(ToJson{}, message).dump(-1, ' ', false, json::error_handler_t::replace);
}

std::optional<Message> decode(const std::string& line) {
  const json message = json::parse(line, nullptr, false);
  if (!message.is_object()) return std::nullopt;
  if (const auto begin = message.find("begin"); begin != message.end()) {
    if (!begin->is_number_unsigned()) return std::nullopt;
    return TaskBegins{begin->get<std::size_t>()};
  }
  if (const auto result = message.find("result"); result != message.end()) {
    auto parsed = case_result_from_json(*result);
    return parsed ? std::optional<Message>(std::move(*parsed)) : std::nullopt;
  }
  if (const auto error = message.find("error"); error != message.end()) {
    auto parsed = error_from_json(*error);
    return parsed ? std::optional<Message>(std::move(*parsed)) : std::nullopt;
  }
  if (message.contains("done")) return BatchDone{};
  return std::nullopt;
}

}  // namespace attest
