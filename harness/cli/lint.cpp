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

}  // namespace

int lint(const VectorOptions& options, const Globals& globals) {
  const auto suite = find_suite(globals.suite);
  if (!suite) return report_error(suite.error());
  const auto cases = options.select.cases_in(suite->case_folders());
  if (!cases) return report_error(cases.error());
  const SuiteMargins margins = suite_margins(*cases);
  for (const VectorMargin& vector : margins.too_near) print_refused(vector);
  if (!globals.quiet) print_nearest(margins);
  return margins.too_near.empty() ? exit_ok : exit_failed;
}

}  // namespace attest::cli
