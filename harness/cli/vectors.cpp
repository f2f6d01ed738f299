#include <optional>
#include <string>

#include <fmt/format.h>

#include "harness/cli/command.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/host/manifest.hpp"
#include "harness/verify/recorded_vectors.hpp"

namespace attest::cli {
namespace {

Result<std::size_t> write_vectors(const VectorOptions& options, const Globals& globals) {
  const auto format = parse_table_format(options.format);
  if (!format) return tl::unexpected(format.error());
  std::optional<Rate> fixed_step;
  if (!options.fixed_step.empty()) {
    const auto rate = Rate::parse(options.fixed_step);
    if (!rate) return tl::unexpected(rate.error());
    fixed_step = *rate;
  }
  const auto suite = find_suite(globals.suite);
  if (!suite) return tl::unexpected(suite.error());
  if (auto checked = check_output_folder(options.folder, globals.suite); !checked) {
    return tl::unexpected(checked.error());
  }
  const auto cases = options.select.cases_in(suite->case_folders());
  if (!cases) return tl::unexpected(cases.error());
  return write_recorded_vectors(options.folder, *format, *cases, fixed_step);
}

}  // namespace

int vectors_command(const VectorOptions& options, const Globals& globals) {
  const auto count = write_vectors(options, globals);
  if (!count) return report_error(count.error());
  if (!globals.quiet) {
    fmt::print("{} input traces in {}; {} there says how to add the outputs\n", *count,
               options.folder, manifest_name);
  }
  return exit_ok;
}

}  // namespace attest::cli
