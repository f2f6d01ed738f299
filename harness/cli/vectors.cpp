#include <filesystem>
#include <map>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "harness/casefile/stimulus.hpp"
#include "harness/cli/command.hpp"
#include "harness/cli/outputs.hpp"
#include "harness/cli/suite_folder.hpp"
#include "harness/trace/csv.hpp"
#include "harness/trace/provenance.hpp"

namespace attest::cli {
namespace {

// The file has all inputs, including the constants, so that a port on a board needs this file only.
Result<void> write_vector(const Case& the_case, const Rate& rate,
                          const std::filesystem::path& path) {
  Trace trace = stimulate(the_case, rate);
  trace.present &= ~channels_of(the_case.module, "out/");
  return write_csv(path, trace, all_columns(trace));
}

Result<void> write_origin(const Case& the_case, const std::vector<RunConfiguration>& configurations,
                          const std::filesystem::path& folder) {
  std::map<std::string, std::string> mixers;
  if (the_case.module == Module::mixer) {
    for (const RunConfiguration& configuration : configurations)
      mixers[configuration.label()] = the_case.mixer;
  }
  return add_origin(folder, the_case.profile, mixers);
}

Result<std::size_t> write_vectors(const VectorOptions& options, const Globals& globals) {
  const auto suite = find_suite(globals.suite);
  if (!suite) return tl::unexpected(suite.error());
  if (auto checked = check_output_folder(options.folder, *suite); !checked) {
    return tl::unexpected(checked.error());
  }
  const auto cases = options.select.cases_in(suite->cases());
  if (!cases) return tl::unexpected(cases.error());
  std::size_t count = 0;
  for (const auto& [the_case, configurations] : *cases) {
    if (the_case.flight) continue;  // the inputs of a flight depend on the port's outputs
    const std::filesystem::path folder = std::filesystem::path(options.folder) / the_case.id();
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) return fail_at(folder.string(), fmt::format("cannot be made: {}", error.message()));
    if (auto written = write_origin(the_case, configurations, folder); !written) {
      return tl::unexpected(written.error());
    }
    for (const RunConfiguration& configuration : configurations) {
      auto written =
          write_vector(the_case, configuration.rate, folder / (configuration.label() + ".csv"));
      if (!written) return tl::unexpected(written.error());
      ++count;
    }
  }
  if (count == 0) {
    return fail(
        "only flights are selected, and the inputs of a flight depend on the port's outputs; "
        "`attest sim` writes a flown trace");
  }
  return count;
}

}  // namespace

int vectors_command(const VectorOptions& options, const Globals& globals) {
  const auto count = write_vectors(options, globals);
  if (!count) return report_error(count.error());
  if (!globals.quiet) fmt::print("{} input traces in {}\n", *count, options.folder);
  return exit_ok;
}

}  // namespace attest::cli
