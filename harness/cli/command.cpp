#include "harness/cli/command.hpp"

#include <fmt/format.h>

namespace attest::cli {

int report_error(const Error& error) {
  fmt::print(stderr, "attest: error: {}\n", error.to_string());
  return exit_usage;
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
