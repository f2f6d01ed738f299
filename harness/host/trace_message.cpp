#include "harness/host/trace_message.hpp"

#include <bit>
#include <cstdint>

namespace attest {

using nlohmann::json;

json changes_json(const std::vector<ParameterChange>& changes) {
  json list = json::array();
  for (const ParameterChange& change : changes) {
    list.push_back({change.tick, change.name, std::bit_cast<std::uint32_t>(change.value)});
  }
  return list;
}

std::vector<ParameterChange> changes_from(const json& list) {
  std::vector<ParameterChange> changes;
  for (const json& one : list) {
    changes.push_back({one.at(0).get<std::size_t>(), one.at(1).get<std::string>(),
                       std::bit_cast<float>(one.at(2).get<std::uint32_t>())});
  }
  return changes;
}

void set_end(const std::optional<PortFault>& fault, const std::optional<Divergence>& lost,
             json& head) {
  if (fault) head["fault"] = {{"kind", fault->kind}, {"tick", fault->tick}, {"what", fault->what}};
  if (lost) head["divergence"] = {{"at_ns", lost->at.count()}, {"what", lost->what}};
}

std::optional<PortFault> fault_from(const json& head, bool of_program) {
  if (!head.contains("fault")) return std::nullopt;
  const json& fault = head.at("fault");
  PortFault found{fault.at("kind").get<PortFault::Kind>(), fault.at("tick").get<std::size_t>(),
                  fault.at("what").get<std::string>()};
  const auto last = of_program ? PortFault::Kind::crash : PortFault::Kind::protocol;
  if (found.kind > last) found.kind = PortFault::Kind::protocol;
  return found;
}

std::optional<Divergence> divergence_from(const json& head) {
  if (!head.contains("divergence")) return std::nullopt;
  const json& lost = head.at("divergence");
  return Divergence{Nanoseconds(lost.at("at_ns").get<std::int64_t>()),
                    lost.at("what").get<std::string>()};
}

}  // namespace attest
