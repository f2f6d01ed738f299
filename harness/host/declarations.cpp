#include "harness/host/declarations.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace attest {
namespace {

std::string words_of(const std::optional<int>& bits) {
  return bits ? fmt::format("fixed:{}", *bits) : "none";
}

std::string words_of(const std::optional<Rate>& rate) { return rate ? rate->to_string() : "none"; }

std::string words_of(const std::optional<CostCounter>& cost) {
  return cost ? cost->to_string() : "none";
}

std::string words_of(const ModuleSet& set) {
  std::vector<std::string_view> names;
  for (const ModuleInfo& info : modules()) {
    if (contains(set, info.module)) names.push_back(info.name);
  }
  return fmt::format("{}", fmt::join(names, ","));
}

std::string words_of(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ","));
}

}  // namespace

std::string change(const Declarations& said, const Declarations& now) {
  const auto changed = [](const char* what, const std::string& before, const std::string& after) {
    if (before == after) return std::string();
    return fmt::format(
        "its {} is `{}`, it was `{}` when the port was asked first; it must answer "
        "the same each time",
        what, after, before);
  };
  for (const std::string& difference :
       {changed("name", said.name, now.name), changed("version", said.version, now.version),
        changed("attest.unsupported_groups", words_of(said.unsupported_groups),
                words_of(now.unsupported_groups)),
        changed("attest.lacks", words_of(said.lacks.words), words_of(now.lacks.words)),
        changed("attest.arithmetic", words_of(said.fraction_bits), words_of(now.fraction_bits)),
        changed("attest.fixed_step", words_of(said.fixed_step), words_of(now.fixed_step)),
        changed("list of modules", words_of(said.modules), words_of(now.modules)),
        changed("list of files", words_of(said.files), words_of(now.files)),
        changed("cost", words_of(said.cost), words_of(now.cost))}) {
    if (!difference.empty()) return difference;
  }
  return "";
}

PortFault no_unit_of(const std::string& profile, const Declarations& said) {
  const auto& made = said.profiles;
  if (std::find(made.begin(), made.end(), profile) == made.end()) {
    return {PortFault::Kind::profile, 0,
            fmt::format("the port does not support profile {}", profile)};
  }
  return {PortFault::Kind::protocol, 0,
          fmt::format("create(\"{}\") returned NULL; it made a unit when the port was asked first",
                      profile)};
}

std::optional<PortFault> held_to(const Declarations& said, const std::string& profile,
                                 std::optional<PortFault> fault) {
  if (fault && fault->kind == PortFault::Kind::profile) return no_unit_of(profile, said);
  return fault;
}

Declarations Declarations::asked(const Port& port) {
  return {port.name(),
          port.version(),
          port.unsupported_groups(),
          port.lacks(),
          port.fraction_bits(),
          port.fixed_step(),
          port.modules(),
          {},
          false,
          port.files(),
          port.cost()};
}

}  // namespace attest
