#include "harness/cli/command.hpp"

#include <fmt/format.h>

namespace attest::cli {

int report_error(const Error& error) {
  fmt::print(stderr, "attest: error: {}\n", error.to_string());
  return exit_usage;
}

void SelectionOptions::add_to(CLI::App& command) {
  command
      .add_option("--filter", filters,
                  "Only cases whose id matches this shell pattern; quote it. Ids are "
                  "PROFILE/GROUP/NAME@RATEhz; profile and rate may be left out")
      ->type_name("GLOB")
      ->allow_extra_args(false);
  command.add_option("--group", groups, "Only this group of cases")
      ->type_name("GROUP")
      ->allow_extra_args(false);
  command.add_option("--profile", profiles, "Only this version of the law")
      ->type_name("PROFILE")
      ->allow_extra_args(false);
  command.add_option("--rate", rates, "Only these loop rates [Hz], separated by commas")
      ->type_name("HZ,...")
      ->delimiter(',')
      ->allow_extra_args(false);
}

Result<Selection> SelectionOptions::selection() const {
  Selection selection;
  selection.filters = filters;
  selection.groups = groups;
  selection.profiles = profiles;
  for (const std::string& text : rates) {
    const auto rate = Rate::parse(text);
    if (!rate) return tl::unexpected(rate.error());
    selection.rates.push_back(*rate);
  }
  return selection;
}

}  // namespace attest::cli
