#include "harness/cli/vectors.hpp"

#include <optional>
#include <string>

#include <fmt/format.h>

#include "harness/cli/outputs.hpp"
#include "harness/cli/shared_arguments.hpp"
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
  const auto parameters = parse_parameters(options.parameters, *cases);
  if (!parameters) return tl::unexpected(parameters.error());
  return write_recorded_vectors(options.folder, **format, *cases, fixed_step, *parameters);
}

int vectors_command(const VectorOptions& options, const Globals& globals) {
  if (options.lint) return lint(options, globals);
  if (options.folder.empty()) {
    return report_error({"folder is required; attest vectors --help describes the options"});
  }
  if (!options.from_log.empty()) return vectors_from_log(options, globals);
  const auto count = write_vectors(options, globals);
  if (!count) return report_error(count.error());
  if (!globals.quiet) {
    fmt::print("{} input traces in {}; {} there says how to add the outputs\n", *count,
               options.folder, manifest_name);
  }
  return exit_ok;
}

// Options of the case that is made of a log.
void add_from_log(Command command, VectorOptions& options) {
  const Option log =
      command
          .option("--from-log", options.from_log,
                  "Make a case from this flight log in the suite DIR instead; of v1.14 to v1.18, "
                  "a case of each unit")
          .type("FLIGHT.ulg")
          .group(option_group::logs);
  const auto add_time = [&](const char* name, auto& value, const char* what) {
    command.option(name, value, what)
        .type("S")
        .at_least_zero()
        .needs(log)
        .group(option_group::logs);
  };
  add_time("--from", options.from_s,
           "Begin at this time after the first step in the log [s]; default: 0");
  add_time("--to", options.to_s,
           "End before this time after the first step in the log [s]; default: the end of "
           "the log");
  add_assumed(command, options.assumed);
  command.find("--assume").needs(log);
  for (const char* other : {"--lint", "--format", "--fixed-step", "--param", "--filter",
                            "--exclude", "--group", "--rate"}) {
    log.excludes(command.find(other));
  }
}

}  // namespace

void add_vectors(const CommandLine& line) {
  auto options = std::make_shared<VectorOptions>();
  const Command command = line.add(
      "vectors", "Write the inputs of the vectors to files, for a port that attest cannot start");
  const Option folder =
      command
          .option("folder", options->folder,
                  "Folder for the files; with --from-log, the folder of the suite")
          .type("DIR");
  const Option lint =
      command.flag("--lint", options->lint,
                   "Write no files; report vectors so near to a threshold of the law that correct "
                   "ports may differ");
  lint.excludes(folder);
  command
      .flag("-v,--verbose", options->verbose,
            "With --lint, for each profile and decision of the law: report the vectors on and next "
            "to the threshold, and exit with 1 if one is missing")
      .needs(lint);
  command.option("--format", options->format, "Format of the files: `csv` or `mat` (MATLAB)")
      .type("FORMAT")
      .shows_default()
      .excludes(lint);
  command
      .option("--fixed-step", options->fixed_step,
              "Only vectors at this rate whose ticks are one period apart; their timestamps "
              "are changed to begin at one period; default: all vectors, unchanged")
      .type("HZ")
      .excludes(lint);
  add_parameters(command, options->parameters,
                 "Replace a parameter of each case; `run --port recorded:DIR` then does the same")
      .excludes(lint);
  add_selection(command, options->select, Selects::open_loop);
  add_from_log(command, *options);
  command.examples(
      {{"attest vectors DIR --group attitude --rate 250", "write the inputs of some cases"},
       {"attest vectors DIR --format mat --fixed-step 250",
        "write all vectors that a Simulink model with a sample time of 4 ms can run"},
       {"attest vectors ours --from-log flight.ulg --from 10 --to 20",
        "make a case from ten seconds of a flight, in the suite `ours`"},
       {"attest vectors --lint",
        "report vectors for which rounding decides at a threshold of the law"},
       {"attest vectors --lint --verbose",
        "report also which thresholds have no vector on them or next to them"}});
  command.runs(options, vectors_command);
}

}  // namespace attest::cli
