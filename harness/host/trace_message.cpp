#include "harness/host/trace_message.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

#include <fmt/format.h>

#include "harness/core/error_json.hpp"
#include "harness/core/printable.hpp"

namespace attest {

using nlohmann::json;

namespace {

// A text for people in one line. A text that is too long is cut.
std::string words_from(JsonReader& head, const char* key) {
  constexpr std::size_t longest = 4000;
  return printable_part(head.text(key).substr(0, longest));
}

}  // namespace

tl::unexpected<Error> error_in(JsonReader& head) {
  auto error = error_from_json(head.member("error"));
  if (!error) return tl::unexpected(error.error());
  constexpr std::size_t longest = 4000;
  for (std::string* text : {&error->message, &error->file}) {
    *text = printable(text->substr(0, longest));
  }
  error->line = std::max(error->line, 0);
  error->column = std::max(error->column, 0);
  return tl::unexpected(*std::move(error));
}

json changes_json(const std::vector<ParameterChange>& changes) {
  json list = json::array();
  for (const ParameterChange& change : changes) {
    list.push_back({{"tick", change.tick},
                    {"name", change.name},
                    {"bits", std::bit_cast<std::uint32_t>(change.value)}});
  }
  return list;
}

std::vector<ParameterChange> changes_from(JsonReader& head, const char* key, std::size_t ticks) {
  std::vector<ParameterChange> changes;
  std::string error;
  for (const json& one : head.list(key)) {
    JsonReader change(one, error);
    const auto tick = static_cast<std::size_t>(change.count("tick", ticks));
    std::string name = change.text("name");
    const auto bits = static_cast<std::uint32_t>(change.count("bits", UINT32_MAX));
    if (!error.empty()) {
      head.wrong(key, "has a wrong change: " + error);
      return {};
    }
    changes.push_back({tick, std::move(name), std::bit_cast<float>(bits)});
  }
  return changes;
}

json to_json(const RunConfiguration& configuration) {
  return {{"rate", configuration.rate.to_string()},
          {"vehicle", configuration.plant_configuration->vehicle},
          {"plant", configuration.plant_configuration->plant}};
}

RunConfiguration configuration_from(const json& in) {
  return {LoopRate::parse(in.at("rate").get<std::string>()).value(),
          PlantConfiguration{in.at("vehicle").get<std::string>(), in.at("plant").get<PlantKind>()}};
}

void set_end(const std::optional<PortFault>& fault, const std::optional<Divergence>& lost,
             json& head) {
  if (fault) head["fault"] = {{"kind", fault->kind}, {"tick", fault->tick}, {"what", fault->what}};
  if (lost) head["divergence"] = {{"at_ns", lost->at.count()}, {"what", lost->what}};
}

std::optional<PortFault> fault_from(JsonReader& head, std::size_t ticks, bool of_program) {
  if (!head.has("fault")) return std::nullopt;
  JsonReader fault = head.object("fault");
  const auto last = of_program ? PortFault::Kind::crash : PortFault::Kind::protocol;
  const auto kind = fault.integer("kind", 0, static_cast<std::int64_t>(last));
  return PortFault{static_cast<PortFault::Kind>(kind),
                   static_cast<std::size_t>(fault.count("tick", ticks)), words_from(fault, "what")};
}

std::optional<PortFault> with_words(std::optional<PortFault> fault, const Child& child,
                                    bool of_program) {
  using enum PortFault::Kind;
  if (!fault) return fault;
  const bool has_ended = fault->kind == crash || fault->kind == protocol;
  const bool has_failed = fault->kind == failed || fault->kind == refused;
  if (has_failed || (of_program && has_ended)) {
    fault->what += child.last_printed();
  }
  return fault;
}

std::optional<Divergence> divergence_from(JsonReader& head, Nanoseconds longest) {
  if (!head.has("divergence")) return std::nullopt;
  JsonReader lost = head.object("divergence");
  return Divergence{Nanoseconds(lost.integer("at_ns", 0, longest.count())),
                    words_from(lost, "what")};
}

}  // namespace attest
