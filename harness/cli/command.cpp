#include "harness/cli/command.hpp"

#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace attest::cli {

int report_error(const Error& error) {
  // Not through fmt::print: it throws when stderr cannot be written.
  std::fputs(fmt::format("attest: error: {}\n", error.to_string()).c_str(), stderr);
  return exit_usage;
}

std::string SelectionOptions::narrowing() const {
  auto options = as_options({{"--filter", filters},
                             {"--exclude", excludes},
                             {"--group", groups},
                             {"--rate", rates},
                             {"--vehicle", vehicles},
                             {"--plant", plants}});
  return fmt::format("{}", fmt::join(options, " "));
}

Result<std::vector<SelectedCase>> SelectionOptions::cases_in(const CaseFolders& folders) const {
  Selection selection;
  selection.filters = filters;
  selection.excludes = excludes;
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
  return select_cases(folders, selection);
}

}  // namespace attest::cli
