#include <fmt/format.h>

#include "harness/cli/suite_folder.hpp"
#include "harness/cli/vectors.hpp"
#include "harness/golden/suite_margins.hpp"

namespace attest::cli {
namespace {

void print_refused(const VectorMargin& vector) {
  const auto& [the_case, configuration, decision, margin] = vector;
  fmt::print(stderr,
             "attest: error: {}: at {}, tick {}, {} is at {:.2g}; a numeric vector needs {} {:g}, "
             "or `level = \"exact\"`\n",
             the_case->file.string(), configuration.label(), margin.tick, name_of(decision),
             margin.distance, decision == Decision::quaternion_norm ? "at most" : "at least",
             least_margin(decision));
}

void print_nearest(const SuiteMargins& margins) {
  fmt::print("{:<21} {:>9} {:>9}  {}\n", "decision", "nearest", "bound", "where");
  for (const auto& [the_case, configuration, decision, margin] : margins.nearest) {
    if (the_case == nullptr) continue;
    fmt::print("{:<21} {:>9.2g} {:>9.2g}  {}@{} at tick {}\n", name_of(decision), margin.distance,
               least_margin(decision), the_case->id(), configuration.label(), margin.tick);
  }
  fmt::print("{} numeric vectors, {} too near to a decision", margins.vectors,
             margins.too_near.size());
  if (margins.not_measured == 0) return fmt::print("\n");
  fmt::print("; {} more without known decisions: battery estimates, profiles of your own\n",
             margins.not_measured);
}

// The vector in a place next to a decision, or why there is none.
std::string what_is_at(const Approach& approach, Decision decision, Place place) {
  if (const auto reason = reason_for_none(decision, place); !reason.empty()) {
    return fmt::format("{:>9}  no case: {}", "", reason);
  }
  const auto& [the_case, configuration, measured, margin] = approach.at(place);
  if (the_case == nullptr) return fmt::format("{:>9}  MISSING", "");
  return fmt::format("{:>9.2g}  {}@{} at tick {}{}", margin.distance, the_case->id(),
                     configuration.label(), margin.tick,
                     approach.has(decision, place) ? "" : ": MISSING, this is too far");
}

// Prints the vectors on and next to each threshold. Returns how many are missing.
std::size_t print_approaches(const SuiteMargins& margins) {
  std::size_t missing = 0;
  for (const auto& [profile, approaches] : margins.approaches) {
    fmt::print("\n{}\n{:<21} {:<5} {:>9}  {}\n", profile, "decision", "place", "distance", "where");
    for (std::size_t i = 0; i < decision_count; ++i) {
      const auto decision = static_cast<Decision>(i);
      if (!approaches[i].is_reached()) continue;
      for (const Place place : all_places) {
        fmt::print("{:<21} {:<5} {}\n", name_of(decision), name_of(place),
                   what_is_at(approaches[i], decision, place));
        const bool can_be = reason_for_none(decision, place).empty();
        if (can_be && !approaches[i].has(decision, place)) ++missing;
      }
    }
  }
  fmt::print(
      "\n{} places without a vector: each decision of a profile needs one on its threshold at the "
      "level exact, and one within {:g} bounds on each side at numeric\n",
      missing, near_margins);
  return missing;
}

}  // namespace

int lint(const VectorOptions& options, const Globals& globals) {
  const auto suite = find_suite(globals.suite);
  if (!suite) return report_error(suite.error());
  const auto cases = options.select.cases_in(suite->case_folders());
  if (!cases) return report_error(cases.error());
  const SuiteMargins margins = suite_margins(*cases);
  for (const VectorMargin& vector : margins.too_near) print_refused(vector);
  if (!globals.quiet) print_nearest(margins);
  const std::size_t missing = options.verbose ? print_approaches(margins) : 0;
  return margins.too_near.empty() && missing == 0 ? exit_ok : exit_failed;
}

}  // namespace attest::cli
