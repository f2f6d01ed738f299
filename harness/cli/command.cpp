#include "harness/cli/command.hpp"

#include <fmt/format.h>

namespace attest::cli {

int report_error(const Error& error) {
  fmt::print(stderr, "attest: error: {}\n", error.to_string());
  return exit_usage;
}

Result<std::vector<SelectedCase>> SelectionOptions::cases_in(
    const std::filesystem::path& folder) const {
  Selection selection;
  selection.filters = filters;
  selection.groups = groups;
  selection.profiles = profiles;
  selection.vehicles = vehicles;
  selection.plants = plants;
  for (const std::string& text : rates) {
    const auto rate = Rate::parse(text);
    if (!rate) return tl::unexpected(rate.error());
    selection.rates.push_back(*rate);
  }
  const auto part = Shard::parse(shard);
  if (!part) return tl::unexpected(part.error());
  selection.shard = *part;
  return select_cases(folder, selection);
}

}  // namespace attest::cli
