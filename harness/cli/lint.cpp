#include <array>

#include <fmt/format.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/cli/command.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/golden/margins.hpp"

namespace attest::cli {
namespace {

struct Nearest {
  Margin margin;
  std::string where;
};

bool is_nearer(Decision decision, const Margin& margin, const Nearest& nearest) {
  if (std::isinf(margin.distance)) return false;
  if (nearest.where.empty()) return true;
  const bool largest = decision == Decision::quaternion_norm;
  return largest ? margin.distance > nearest.margin.distance
                 : margin.distance < nearest.margin.distance;
}

// On purpose, and both branches are right.
bool stands_on(const EitherBranch& branches, Decision decision) {
  return (branches.yaw_wrap && decision == Decision::yaw_wrap) ||
         (branches.shorter_rotation && decision == Decision::shorter_rotation);
}

}  // namespace

int lint_command(const VectorOptions& options, const Globals& globals) {
  const auto suite = find_suite(globals.suite);
  if (!suite) return report_error(suite.error());
  const auto cases = options.select.cases_in(suite->cases());
  if (!cases) return report_error(cases.error());
  std::array<Nearest, decision_count> nearest;
  std::size_t vectors = 0, refused = 0;
  for (const auto& [the_case, configurations] : *cases) {
    if (the_case.flight || the_case.exact_only) continue;
    for (const RunConfiguration& configuration : configurations) {
      const Margins found = margins(stimulate(the_case, configuration.rate), subject_of(the_case));
      ++vectors;
      for (std::size_t i = 0; i < decision_count; ++i) {
        const auto decision = static_cast<Decision>(i);
        if (stands_on(the_case.either_branch, decision)) continue;
        const Margin& margin = found[decision];
        const std::string where =
            fmt::format("{}@{} at tick {}", the_case.id(), configuration.label(), margin.tick);
        if (is_nearer(decision, margin, nearest[i])) nearest[i] = {margin, where};
        if (found.is_safe(decision)) continue;
        ++refused;
        fmt::print(stderr,
                   "attest: error: {}: at {}, tick {}, {} is at {:.2g}; a numeric vector "
                   "needs {} {:g}, or `level = \"exact\"`\n",
                   the_case.file.string(), configuration.label(), margin.tick, name_of(decision),
                   margin.distance, decision == Decision::quaternion_norm ? "at most" : "at least",
                   least_margin(decision));
      }
    }
  }
  if (!globals.quiet) {
    fmt::print("{:<20} {:>9} {:>9}  {}\n", "decision", "nearest", "bound", "where");
    for (std::size_t i = 0; i < decision_count; ++i) {
      const auto decision = static_cast<Decision>(i);
      if (nearest[i].where.empty()) continue;
      fmt::print("{:<20} {:>9.2g} {:>9.2g}  {}\n", name_of(decision), nearest[i].margin.distance,
                 least_margin(decision), nearest[i].where);
    }
    fmt::print("{} numeric vectors, {} too near to a decision\n", vectors, refused);
  }
  return refused == 0 ? exit_ok : exit_failed;
}

}  // namespace attest::cli
