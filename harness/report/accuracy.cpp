#include "harness/report/accuracy.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace attest {
namespace {

using ByGroup = std::map<std::string, double>;

// "large_angle 0.0021, attitude 3.1e-06": the groups with the largest deviations.
std::string worst_groups(const ByGroup& groups) {
  constexpr std::size_t shown = 3;
  std::vector<std::pair<std::string, double>> sorted(groups.begin(), groups.end());
  std::ranges::stable_sort(sorted, std::ranges::greater{}, &std::pair<std::string, double>::second);
  sorted.resize(std::min(sorted.size(), shown));
  std::vector<std::string> texts;
  for (const auto& [group, deviation] : sorted) {
    texts.push_back(fmt::format("{} {:.2g}", group, deviation));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

double largest(const ByGroup& groups) {
  return std::ranges::max_element(groups, {}, &ByGroup::value_type::second)->second;
}

}  // namespace

std::optional<DocumentTable> accuracy_of(const RunResult& run) {
  std::map<std::size_t, ByGroup> signals;
  for (const VectorResult& result : run.results) {
    if (!is_judged(result.verdict)) continue;
    for (const auto& [channel, deviation] : result.largest) {
      double& known = signals[channel][result.group];
      known = std::max(known, deviation);
    }
  }
  if (signals.empty()) return std::nullopt;
  DocumentTable table{
      "accuracy: the largest deviation of each signal, and the groups where it is "
      "largest",
      {"signal", "unit", "largest", "groups"}};
  for (const auto& [index, groups] : signals) {
    const Channel& channel = channels()[index];
    const bool is_shared = channels_named(channel.name).count() > 1;
    const std::string of = is_shared ? fmt::format(" of {}", name_of(channel.module)) : "";
    table.rows.push_back({std::string(channel.name) + of, std::string(unit_of(channel.quantity)),
                          fmt::format("{:.2g}", largest(groups)), worst_groups(groups)});
  }
  return table;
}

}  // namespace attest
