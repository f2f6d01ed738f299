#include <string>

#include <fmt/format.h>

#include "harness/cli/command.hpp"
#include "harness/compare/compare_files.hpp"
#include "harness/report/failure_text.hpp"

namespace attest::cli {
namespace {

// The part of a result that the report shows; files have neither port nor case.
CaseResult as_result(const Comparison& comparison) {
  CaseResult result;
  result.ticks = comparison.ticks;
  result.deviating_ticks = comparison.deviating_ticks;
  result.first = comparison.first;
  result.worst = comparison.worst;
  return result;
}

}  // namespace

int compare_command(const CompareOptions& options, const Globals& globals) {
  const auto level = parse_level(options.level);
  if (!level) return report_error(level.error());
  const auto compared = compare_files(options.got, options.want, Tolerances(*level));
  if (!compared) return report_error(compared.error());
  const Comparison& comparison = *compared;
  if (!comparison.agrees()) {
    fmt::print("differ: {} (got), {} (want)\n", options.got, options.want);
    if (!comparison.mismatch.empty()) fmt::print("  {}\n", comparison.mismatch);
    fmt::print("{}", finding_text(as_result(comparison), *level));
    return exit_failed;
  }
  if (!globals.quiet) {
    fmt::print("agree: {} ticks, {}", comparison.ticks, name_of(*level));
    if (comparison.tightest) {
      fmt::print(", tightest headroom {:.3g}x on {} at tick {}", comparison.tightest->ratio,
                 channels()[comparison.tightest->channel].name, comparison.tightest->tick);
    }
    fmt::print("\n");
  }
  return exit_ok;
}

}  // namespace attest::cli
